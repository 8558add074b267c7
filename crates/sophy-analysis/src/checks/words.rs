//! Words that several messages use.

use crate::declarations::ComponentKind;

/// `a continuous-time component (CTC)`.
pub(crate) fn kind_with_article(kind: ComponentKind) -> &'static str {
    match kind {
        ComponentKind::Ctc => "a continuous-time component (CTC)",
        ComponentKind::Dtc => "a discrete-time component (DTC)",
        ComponentKind::Lbc => "a logic-based component (LBC)",
        ComponentKind::Cc => "a composite component (CC)",
        ComponentKind::System => "a SYSTEM",
    }
}
