use std::path::Path;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, Options, Tree};

use crate::FileError;

const FONT: &[u8] = include_bytes!("../../fonts/Roboto-Regular-subset.ttf");
/// Pixels of the image for a CSS pixel: 192 to the inch.
const SCALE: f32 = 2.0;

/// The same picture in pixels, its text set in the embedded font.
pub(crate) fn png(path: &Path, svg: &str) -> Result<Vec<u8>, FileError> {
    let tree = tree(svg).map_err(FileError::format(path, "PNG"))?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let pixmap = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut pixmap =
        pixmap.ok_or(FileError::Missing { path: path.to_path_buf(), missing: "no room for a picture" })?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(FileError::format(path, "PNG"))
}

fn tree(svg: &str) -> Result<Tree, usvg::Error> {
    let mut options = Options { font_family: "Roboto".to_owned(), ..Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("Roboto");
    Tree::from_str(svg, &options)
}

#[cfg(test)]
mod tests {
    use super::super::text;
    use super::*;

    #[test]
    fn the_table_of_widths_is_that_of_the_embedded_font() {
        for sample in ["position", "WAVE To.", "0123456789", "Decompression (m/s)"] {
            let svg = format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"900\" height=\"50\">\
                 <text x=\"10\" y=\"30\" font-family=\"Roboto\" font-size=\"20\">{sample}</text></svg>"
            );
            let tree = tree(&svg).unwrap();
            let drawn = f64::from(tree.root().bounding_box().width());
            let reckoned = text::width(sample, 20.0);
            assert!((drawn - reckoned).abs() < 0.06 * reckoned, "{sample}: {drawn} and {reckoned}");
        }
    }
}
