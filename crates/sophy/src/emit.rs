//! Text forms of what the stages between file and run make, for bug reports and the curious.

use sophy_analysis::{Declarations, write_hsml};
use sophy_ir::Model;

/// What a file and its imports declare, as HSML in the canonical layout: what was understood, before names are
/// resolved. Of a file with mistakes it is what is left.
pub fn declarations_text(declarations: &Declarations) -> String {
    write_hsml(declarations)
}

/// A checked model: names are resolved, expressions are graphs.
pub fn model_text(model: &Model) -> String {
    model.to_string()
}

/// The flat system a run computes with.
///
/// # Errors
/// [`crate::Error::Composition`] if the model is no system.
pub fn system_text(model: &Model) -> Result<String, crate::Error> {
    Ok(sophy_passes::lower(model)?.to_string())
}
