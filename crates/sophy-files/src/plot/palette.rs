//! Colours that people with any colour vision can tell apart: Okabe and Ito, "Color Universal Design" (2008).

/// Curves of one panel.
pub(super) const CURVES: [&str; 7] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"];

/// Locations; yellow and grey last, for they are weak on white.
const LOCATIONS: [[u8; 3]; 8] = [
    [0x56, 0xB4, 0xE9],
    [0xE6, 0x9F, 0x00],
    [0x00, 0x9E, 0x73],
    [0xCC, 0x79, 0xA7],
    [0x00, 0x72, 0xB2],
    [0xD5, 0x5E, 0x00],
    [0xF0, 0xE4, 0x42],
    [0x80, 0x80, 0x80],
];

/// Pixels where locations change faster than the picture can show.
pub(super) const FAST: &str = "#6b6b6b";

/// Truth values on strips: what is true stands out.
pub(super) const TRUE: &str = "#8fc1e3";
pub(super) const FALSE: &str = "#ececec";

/// Colour and dash pattern of the n-th curve of a panel.
pub(super) fn curve(n: usize) -> (&'static str, &'static str) {
    let dashes = ["", "6 2.5", "1.5 2"];
    (CURVES[n % CURVES.len()], dashes[n / CURVES.len() % dashes.len()])
}

/// Full colour of a location, for lines.
pub(crate) fn location(n: u32) -> String {
    mixed(n, 1.0)
}

/// The location's colour thinned with white, for areas that carry text.
pub(super) fn location_band(n: u32) -> String {
    mixed(n, 0.55)
}

/// The location's colour as a hint behind curves.
pub(crate) fn location_shade(n: u32) -> String {
    mixed(n, 0.13)
}

/// Beyond eight locations the colours return paler.
fn mixed(n: u32, strength: f64) -> String {
    let n = n as usize;
    let strength = if n < LOCATIONS.len() { strength } else { 0.5 * strength };
    let [r, g, b] = LOCATIONS[n % LOCATIONS.len()].map(|c| (255.0 - strength * f64::from(255 - c)) as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
