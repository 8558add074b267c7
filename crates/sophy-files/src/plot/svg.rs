//! A sheet of SVG. Attributes come from this crate only; every text from outside is escaped here.

use std::fmt::Write;

use super::curve::round;
use super::text::{FAMILY, escaped};

pub(super) const INK: &str = "#222";
pub(super) const TEXT: f64 = 11.0;

pub(super) struct Svg {
    out: String,
}

/// Which point of a text stands at the given place.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    /// A white sheet of `width` × `height` CSS pixels.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let (width, height) = (libm::ceil(width), libm::ceil(height));
        let mut out = String::new();
        let _ = write!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FAMILY}\" font-size=\"{TEXT}\" role=\"img\">\n\
             <title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n",
            escaped(title)
        );
        Svg { out }
    }

    pub(super) fn line(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), attributes: &str) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(|v| round(v, 2));
        let _ = writeln!(self.out, "<path d=\"M{x1} {y1}L{x2} {y2}\" fill=\"none\" {attributes}/>");
    }

    pub(super) fn rect(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), attributes: &str) {
        let [x, y, width, height] = [x, y, width, height].map(|v| round(v, 2));
        let _ = writeln!(
            self.out,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {attributes}/>"
        );
    }

    pub(super) fn path(&mut self, data: &str, attributes: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.out, "<path d=\"{data}\" fill=\"none\" {attributes}/>");
        }
    }

    pub(super) fn circle(&mut self, (x, y): (f64, f64), radius: f64, attributes: &str) {
        let (x, y) = (round(x, 2), round(y, 2));
        let _ = writeln!(self.out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {attributes}/>");
    }

    /// A text of `size` pixels whose anchor stands at a point of its base line.
    pub(super) fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, size: f64, text: &str) {
        self.put_text(&format!("x=\"{}\" y=\"{}\"", round(x, 2), round(y, 2)), anchor, size, text);
    }

    /// A text that runs upwards, centred at a point of its base line.
    pub(super) fn upright_text(&mut self, (x, y): (f64, f64), size: f64, text: &str) {
        let at = format!("transform=\"translate({} {}) rotate(-90)\"", round(x, 2), round(y, 2));
        self.put_text(&at, Anchor::Middle, size, text);
    }

    fn put_text(&mut self, at: &str, anchor: Anchor, size: f64, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escaped(text);
        let _ = writeln!(
            self.out,
            "<text {at} text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{INK}\">{text}</text>"
        );
    }

    /// What follows is cut at a rectangle, until [`Svg::unclip`]. `name` is unique in the sheet.
    pub(super) fn clip(&mut self, name: &str, corner: (f64, f64), size: (f64, f64)) {
        let _ = writeln!(self.out, "<clipPath id=\"{name}\">");
        self.rect(corner, size, "");
        let _ = writeln!(self.out, "</clipPath>\n<g clip-path=\"url(#{name})\">");
    }

    pub(super) fn unclip(&mut self) {
        self.out.push_str("</g>\n");
    }

    pub(super) fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}
