/// What a plot shows and how large.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotOptions {
    /// Heading; none by default (an HTML page then takes the model's name).
    pub title: Option<String>,
    /// Width and height in CSS pixels (1/96 inch); by default 720 wide and as high as its panels need. A PNG has
    /// twice as many pixels each way.
    pub size: Option<(u32, u32)>,
    /// Names of the variables to show, in this order; by default all.
    pub variables: Option<Vec<String>>,
    /// Two variables (abscissa, ordinate): an SVG or PNG is then their phase portrait instead of the curves over
    /// time, an HTML page has it beside them.
    pub phase: Option<(String, String)>,
}
