//! Vectors and matrices do not fit one another, or stand where a single value is needed.

use crate::lower::Shape;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0211");

/// `a + b`, `a - b`.
pub(crate) fn operands(left: Span, right: Span, operator: &str, shapes: (Shape, Shape)) -> Diagnostic {
    let verb = if operator == "+" { "added to" } else { "taken from" };
    let (first, second) = if operator == "+" { shapes } else { (shapes.1, shapes.0) };
    let error = Diagnostic::error(CODE, left, format!("{first} cannot be {verb} {second}"));
    let error = labelled(error, right, shapes);
    match shapes {
        (Shape::Scalar, array) | (array, Shape::Scalar) => {
            error.help(format!("for the same number in every element write `…*ones({})`", extents(array)))
        }
        _ => error.help("both need the same shape"),
    }
}

/// `a*b` of what cannot be multiplied; as written, `names`.
pub(crate) fn product(spans: (Span, Span), shapes: (Shape, Shape), names: (&str, &str)) -> Diagnostic {
    let (a, b) = names;
    let error =
        Diagnostic::error(CODE, spans.0, format!("{} cannot be multiplied by {}", shapes.0, shapes.1));
    let error = labelled(error, spans.1, shapes);
    match shapes {
        (Shape::Vector(m), Shape::Vector(n)) if m == n => {
            let error = error.help(format!("for the scalar product write `dot({a}, {b})`"));
            let error = if m == 3 {
                error.help(format!("for the vector product write `cross({a}, {b})`"))
            } else {
                error
            };
            error.help("for the products of the elements use a loop")
        }
        (Shape::Vector(m), Shape::Matrix(rows, _)) if m == rows => {
            error.help(format!("for the row times the matrix write `transpose({b})*{a}`"))
        }
        _ => error.help("the left one needs as many columns as the right one has rows"),
    }
}

/// `a/b` by an array.
pub(crate) fn quotient(spans: (Span, Span), shapes: (Shape, Shape), name: &str) -> Diagnostic {
    let error = Diagnostic::error(CODE, spans.1, format!("a division by {} has no meaning", shapes.1));
    match shapes.1 {
        Shape::Matrix(..) => error.help(format!("multiply by the inverse: `inv({name})*…`")),
        _ => error.help("divide element by element in a loop"),
    }
}

/// A power of an array.
pub(crate) fn power(span: Span, written: &str, shape: Shape) -> Diagnostic {
    let error = Diagnostic::error(CODE, span, format!("`{written}` is {shape}, and has no power"));
    match shape {
        Shape::Matrix(..) => error.help(format!("write the product: `{written}*{written}`")),
        _ => error.help(format!("for the square of its length write `dot({written}, {written})`")),
    }
}

/// A comparison of arrays.
pub(crate) fn comparison(span: Span, operator: &str, shapes: (Shape, Shape)) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("{} cannot be compared with {}", shapes.0, shapes.1)).help(format!(
        "compare element by element: `all(i in 1..{} : x[i] {operator} …)`",
        shapes.0.extents().first().or(shapes.1.extents().first()).copied().unwrap_or(1)
    ))
}

/// A single value is needed.
pub(crate) fn not_single(span: Span, written: &str, shape: Shape) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{written}` is {shape}, but a single value is needed here"))
        .help("use one of its elements: `x[1]`")
}

/// `min` or `max`, called `name`, of arrays.
pub(crate) fn not_ordered(span: Span, name: &str, shape: Shape) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` compares numbers, but this is {shape}"))
        .help("compare their lengths, `norm(…)`, or one of their elements")
}

/// An elementary function of an array.
pub(crate) fn not_by_element(span: Span, written: &str, shape: Shape, name: &str) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` is a function of a number, but `{written}` is {shape}"))
        .help(format!("apply it to the elements: `{name}({written}[i])` in a loop"))
}

/// An argument that is not `what` it should be.
pub(crate) fn argument(span: Span, name: &str, what: &str, written: &str, shape: Shape) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` needs {what}, but `{written}` is {shape}"))
        .help(format!("give it {what}"))
}

/// `dot` and `cross`.
pub(crate) fn vectors(name: &str, three: bool, spans: (Span, Span), shapes: (Shape, Shape)) -> Diagnostic {
    let needs = if three { "two vectors of 3" } else { "two vectors of the same length" };
    let error = Diagnostic::error(CODE, spans.0, format!("`{name}` needs {needs}"));
    labelled(error, spans.1, shapes).help("check the extents where they are declared")
}

/// Rows of a matrix that differ.
pub(crate) fn rows(spans: (Span, Span), shapes: (Shape, Shape)) -> Diagnostic {
    Diagnostic::error(
        CODE,
        spans.1,
        format!("the first element is {}, but this one is {}", shapes.0, shapes.1),
    )
    .label(spans.0, shapes.0.to_string())
    .help("all elements of a vector, and all rows of a matrix, have one shape")
}

/// Three dimensions.
pub(crate) fn too_many_dimensions(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "there are vectors and matrices, but nothing with three extents")
        .help("use several matrices, or an array of components")
}

/// The branches of `if`.
pub(crate) fn branches(first: Span, second: Span, shapes: (Shape, Shape)) -> Diagnostic {
    Diagnostic::error(
        CODE,
        second,
        format!("after `then` there is {}, but after `else` {}", shapes.0, shapes.1),
    )
    .label_main(shapes.1.to_string())
    .label(first, shapes.0.to_string())
    .help("both branches need values of one shape")
}

/// What a reduction combines differs in shape.
pub(crate) fn reduced(span: Span, name: &str, shapes: (Shape, Shape)) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{name}` combines {} with {}", shapes.0, shapes.1))
        .help("the body needs one shape for all values of the loop")
}

/// `what`, declared at `declared`, gets a value of another shape.
pub(crate) fn assigned(
    span: Span,
    what: &str,
    declared: Option<Span>,
    expected: Shape,
    found: Shape,
) -> Diagnostic {
    let error = Diagnostic::error(CODE, span, format!("{what} is {expected}, but its value is {found}"));
    match declared {
        Some(declared) => error.label(declared, expected.to_string()),
        None => error,
    }
}

fn labelled(error: Diagnostic, right: Span, shapes: (Shape, Shape)) -> Diagnostic {
    error.label_main(shapes.0.to_string()).label(right, shapes.1.to_string())
}

fn extents(shape: Shape) -> String {
    let extents: Vec<String> = shape.extents().iter().map(ToString::to_string).collect();
    extents.join(", ")
}
