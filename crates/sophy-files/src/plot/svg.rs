//! A sheet of SVG. Attributes come from this crate only; every text from outside is escaped here.

use std::fmt::Write;

use super::curve::round;
use super::text::{FAMILY, escaped};

pub(crate) const INK: &str = "#222";
pub(crate) const TEXT: f64 = 11.0;

pub(crate) struct Svg {
    out: String,
}

/// Which point of a text stands at the given place.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    /// A white sheet of `width` × `height` CSS pixels.
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
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

    pub(crate) fn line(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), attributes: &str) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(|v| round(v, 2));
        let _ = writeln!(self.out, "<path d=\"M{x1} {y1}L{x2} {y2}\" fill=\"none\" {attributes}/>");
    }

    pub(crate) fn rect(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), attributes: &str) {
        let [x, y, width, height] = [x, y, width, height].map(|v| round(v, 2));
        let _ = writeln!(
            self.out,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" {attributes}/>"
        );
    }

    pub(crate) fn path(&mut self, data: &str, attributes: &str) {
        if !data.is_empty() {
            let _ = writeln!(self.out, "<path d=\"{data}\" fill=\"none\" {attributes}/>");
        }
    }

    pub(crate) fn circle(&mut self, (x, y): (f64, f64), radius: f64, attributes: &str) {
        let (x, y) = (round(x, 2), round(y, 2));
        let _ = writeln!(self.out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {attributes}/>");
    }

    /// A text of `size` pixels whose anchor stands at a point of its base line.
    pub(crate) fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, size: f64, text: &str) {
        self.put_text(&format!("x=\"{}\" y=\"{}\"", round(x, 2), round(y, 2)), anchor, size, text);
    }

    /// A text that runs upwards, centred at a point of its base line.
    pub(crate) fn upright_text(&mut self, (x, y): (f64, f64), size: f64, text: &str) {
        let at = format!("transform=\"translate({} {}) rotate(-90)\"", round(x, 2), round(y, 2));
        self.put_text(&at, Anchor::Middle, size, text);
    }

    /// A text of less weight.
    pub(crate) fn grey_text(&mut self, (x, y): (f64, f64), anchor: Anchor, size: f64, text: &str) {
        let at = format!("x=\"{}\" y=\"{}\" opacity=\"0.7\"", round(x, 2), round(y, 2));
        self.put_text(&at, anchor, size, text);
    }

    /// An area; the attributes say how it is filled.
    pub(crate) fn shape(&mut self, data: &str, attributes: &str) {
        let _ = writeln!(self.out, "<path d=\"{data}\" {attributes}/>");
    }

    /// What follows belongs together, until [`Svg::end_group`]; `tip` is shown when the pointer rests on it.
    pub(crate) fn begin_group(&mut self, tip: &str) {
        self.out.push_str("<g>\n");
        if !tip.is_empty() {
            let _ = writeln!(self.out, "<title>{}</title>", escaped(tip));
        }
    }

    pub(crate) fn end_group(&mut self) {
        self.out.push_str("</g>\n");
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
    pub(crate) fn clip(&mut self, name: &str, corner: (f64, f64), size: (f64, f64)) {
        let _ = writeln!(self.out, "<clipPath id=\"{name}\">");
        self.rect(corner, size, "");
        let _ = writeln!(self.out, "</clipPath>\n<g clip-path=\"url(#{name})\">");
    }

    pub(crate) fn unclip(&mut self) {
        self.out.push_str("</g>\n");
    }

    pub(crate) fn finish(mut self) -> String {
        self.out.push_str("</svg>\n");
        self.out
    }
}
