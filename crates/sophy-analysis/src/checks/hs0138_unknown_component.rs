//! A composite has a member that is a copy of nothing, or of itself.

use super::suggestion::suggest;
use crate::declarations::{ComponentDeclaration, Spanned};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0138");

pub(crate) fn diagnostic(name: &Spanned<String>, components: &[&ComponentDeclaration]) -> Diagnostic {
    let names: Vec<&str> = components.iter().map(|component| component.name.value.as_str()).collect();
    let help = suggest(&name.value, &names, "components").help;
    Diagnostic::error(CODE, name.span, format!("there is no component `{}`", name.value))
        .help(help)
        .help("a component of another file is known after `import \"file.hsml\";`")
}

/// Each component has a member of the next, the last of the first.
pub(crate) fn circle(members: &[&ComponentDeclaration]) -> Diagnostic {
    let names: Vec<String> = members.iter().map(|component| format!("`{}`", component.name.value)).collect();
    let first = members[0];
    let message = if members.len() == 1 {
        format!("{} contains itself", names[0])
    } else {
        format!("components contain one another: {}", names.join(", "))
    };
    let mut error = Diagnostic::error(CODE, first.name.span, message);
    for component in &members[1..] {
        error = error.label(component.name.span, "and this one");
    }
    error.help("a component cannot be part of itself: delete the member that leads back")
}
