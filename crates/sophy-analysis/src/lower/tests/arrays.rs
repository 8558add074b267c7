use super::*;

#[test]
fn elements_and_rows() {
    check(&[
        ("p[2]", "p[2]"),
        ("A[2, 3]", "A[2,3]"),
        ("A[n]", "A[3,1]; A[3,2]; A[3,3]"),
        ("A[2][n - 1]", "A[2,2]"),
        ("[1, x, 2*z]", "1; x; 2 * z"),
        ("[[1, 2], [3, z]]", "1; 2; 3; z"),
        ("[1, 2, 3][2]", "2"),
        ("(A*q)[1]", "A[1,1] * q[1] + A[1,2] * q[2] + A[1,3] * q[3]"),
        ("wet[2]", "wet[2] > 0.5"),
        ("size(B)*10 + size(B, 2)", "23"),
    ]);
}

#[test]
fn indices_that_do_not_exist() {
    check(&[
        (
            "p[4]",
            "HS0212 4: index 4 is out of bounds: `p` is a vector of 3 | help: its indices go from 1 to 3",
        ),
        (
            "p[0]",
            "HS0212 0: index 0 is out of bounds: `p` is a vector of 3 | help: indices are counted from 1",
        ),
        (
            "B[2, 4]",
            "HS0212 4: index 4 is out of bounds: `B` is a 2×3 matrix | help: its indices go from 1 to 3",
        ),
        (
            "z[1]",
            "HS0212 [1]: `z` is a single value, and has no element for an index | help: delete the index, or \
             declare a vector",
        ),
        (
            "p[1, 2]",
            "HS0212 [1, 2]: `p` is a vector of 3, and has no element for 2 indices | help: use fewer indices",
        ),
        (
            "p[1.5]",
            "HS0212 1.5: an index must be a whole number, but this is 1.5 | help: write it without a fraction",
        ),
        (
            "p[i]",
            "HS0213 i: an index must be known before a run | note: loops and arrays are written out when the \
             model is read | help: use numbers, constants, loop variables and parameters with a value only",
        ),
    ]);
}

#[test]
fn operators_on_arrays() {
    check(&[
        ("q + [1, 2, z]", "q[1] + 1; q[2] + 2; q[3] + z"),
        ("-q", "-q[1]; -q[2]; -q[3]"),
        ("z*q", "z * q[1]; z * q[2]; z * q[3]"),
        ("q/2", "q[1] / 2; q[2] / 2; q[3] / 2"),
        ("J*[z, w]", "J[1,1] * z + J[1,2] * w; J[2,1] * z + J[2,2] * w"),
        ("[[1, 0], [0, z]]*[w, x]", "w; z * x"),
        ("[[1, 2]]*[[3], [4]]", "11"),
        (
            "B*A[1]",
            "B[1,1] * A[1,1] + B[1,2] * A[1,2] + B[1,3] * A[1,3]; \
                    B[2,1] * A[1,1] + B[2,2] * A[1,2] + B[2,3] * A[1,3]",
        ),
        ("dot(q, [0, 0, 2])", "q[3] * 2"),
        ("cross([1, 0, 0], [0, 1, 0])", "0; 0; 1"),
        ("norm([3, 4])", "5"),
        ("norm(q)", "sqrt(q[1]^2 + q[2]^2 + q[3]^2)"),
        ("transpose(B)", "B[1,1]; B[2,1]; B[1,2]; B[2,2]; B[1,3]; B[2,3]"),
        ("identity(2)", "1; 0; 0; 1"),
        ("zeros(2) + ones(2)", "1; 1"),
        ("ones(1, 2)", "1; 1"),
        ("inv([[2, 0], [0, 4]])", "0.5; 0; 0; 0.25"),
        ("inv([[z, w], [1, 2]])", "2 / (z * 2 - w); -w / (z * 2 - w); -1 / (z * 2 - w); z / (z * 2 - w)"),
        (
            "if on then q else zeros(3)",
            "if on > 0.5 then q[1] else 0; if on > 0.5 then q[2] else 0; if on > 0.5 then q[3] else 0",
        ),
    ]);
}

#[test]
fn shapes_that_do_not_fit() {
    check(&[
        (
            "q + 1",
            "HS0211 q: a vector of 3 cannot be added to a single value (a vector of 3) | 1: a single value | help: \
             for the same number in every element write `…*ones(3)`",
        ),
        (
            "A - B",
            "HS0211 A: a 2×3 matrix cannot be taken from a 3×3 matrix (a 3×3 matrix) | B: a 2×3 matrix | help: \
             both need the same shape",
        ),
        (
            "p*q",
            "HS0211 p: a vector of 3 cannot be multiplied by a vector of 3 (a vector of 3) | q: a vector of 3 | \
             help: for the scalar product write `dot(p, q)` | help: for the vector product write `cross(p, q)` | \
             help: for the products of the elements use a loop",
        ),
        (
            "q*A",
            "HS0211 q: a vector of 3 cannot be multiplied by a 3×3 matrix (a vector of 3) | A: a 3×3 matrix | \
             help: for the row times the matrix write `transpose(A)*q`",
        ),
        (
            "A*[1, 2]",
            "HS0211 A: a 3×3 matrix cannot be multiplied by a vector of 2 (a 3×3 matrix) | [1, 2]: a vector of 2 | \
             help: the left one needs as many columns as the right one has rows",
        ),
        (
            "1/A",
            "HS0211 A: a division by a 3×3 matrix has no meaning | help: multiply by the inverse: `inv(A)*…`",
        ),
        ("A^2", "HS0211 A: `A` is a 3×3 matrix, and has no power | help: write the product: `A*A`"),
        (
            "sin(q)",
            "HS0211 q: `sin` is a function of a number, but `q` is a vector of 3 | help: apply it to the elements: \
             `sin(q[i])` in a loop",
        ),
        (
            "q > 0",
            "HS0211 q > 0: a vector of 3 cannot be compared with a single value | help: compare element by \
             element: `all(i in 1..3 : x[i] > …)`",
        ),
        (
            "[[1, 2], [3]]",
            "HS0211 [3]: the first element is a vector of 2, but this one is a vector of 1 | [1, 2]: a vector of 2 \
             | help: all elements of a vector, and all rows of a matrix, have one shape",
        ),
        (
            "cross(B[1], [1, 2])",
            "HS0211 B[1]: `cross` needs two vectors of 3 (a vector of 3) | [1, 2]: a vector of 2 | help: check the \
             extents where they are declared",
        ),
        (
            "inv(B)",
            "HS0211 B: `inv` needs a square matrix, but `B` is a 2×3 matrix | help: give it a square matrix",
        ),
        (
            "inv([[1, 2], [2, 4]])",
            "HS0220 [[1, 2], [2, 4]]: this matrix has no inverse: its determinant is 0 | help: check its elements; \
             with other values of its parameters it may have one",
        ),
        (
            "zeros(0)",
            "HS0212 0: an extent must be 1 or more, but this is 0 | help: vectors and matrices have at least one element",
        ),
        (
            "if p then 1 else 2",
            "HS0203 p: `p` is a number, but a condition is needed here | help: compare it with something, for \
             example `p > 0`",
        ),
    ]);
    assert!(lower("inv(big)").messages().starts_with("HS0213"));
}

#[test]
fn reductions_are_written_out() {
    check(&[
        ("sum(j in 1..3 : q[j]*j)", "q[1] + q[2] * 2 + q[3] * 3"),
        ("sum(j in 1..n : q[j])", "q[1] + q[2] + q[3]"),
        ("min(j in 1..3 where j <> 2 : q[j]) < 2", "min(q[1], q[3]) < 2"),
        ("sum(r in 1..2, c in r + 1..3 : B[r, c])", "B[1,2] + B[1,3] + B[2,3]"),
        ("all(j in 1..2 : q[j] > j)", "q[1] > 1 and q[2] > 2"),
        ("any(j in 1..2 : wet[j])", "wet[1] > 0.5 or wet[2] > 0.5"),
        ("sum(j in 1..2 : B[j])", "B[1,1] + B[2,1]; B[1,2] + B[2,2]; B[1,3] + B[2,3]"),
        ("sum(q) + max(q)", "q[1] + q[2] + q[3] + max(max(q[1], q[2]), q[3])"),
        ("all(wet)", "wet[1] > 0.5 and wet[2] > 0.5"),
        ("sum(j in 1..0 : q[j])", "0"),
        ("all(j in 1..0 : q[j] > 1)", "true"),
        ("sum(j in 1..2 : sum(j in 1..2 : j)*j)", "9"),
    ]);
}

#[test]
fn reductions_with_mistakes() {
    check(&[
        (
            "max(j in 3..2 : q[j])",
            "HS0216 3..2: `max` of nothing has no value | note: no value of the loop is left | help: check the \
             range, and the condition after `where`",
        ),
        (
            "product(j in 1..2 : q[j])",
            "HS0201 product: `product` cannot combine the values of a loop | help: declare it, or use one of the \
             functions that can: `sum`, `min`, `max`, `all`, `any`",
        ),
        (
            "sum(j in 1..9 : q[j])",
            "HS0212 j: index 4 is out of bounds: `q` is a vector of 3 | help: its indices go from 1 to 3",
        ),
        (
            "sum(j in 1..3 where q[j] > 0 : 1)",
            "HS0213 q[j] > 0: the condition after `where` must be known before a run | note: loops and arrays are \
             written out when the model is read | help: use numbers, constants, loop variables and parameters \
             with a value only",
        ),
        (
            "all(j in 1..2 : q[j])",
            "HS0210 q[j]: `q[j]` is a real number, but a condition is needed here | help: compare it with \
             something, for example `q[j] > 0`",
        ),
        ("sum(j in 1..2 : yy)", "unknown yy"),
        (
            "min(j in 1..2 : A[j])",
            "HS0211 A[j]: `min` compares numbers, but this is a vector of 3 | help: compare their lengths, \
             `norm(…)`, or one of their elements",
        ),
    ]);
    assert!(lower("sum(j in 1..1e9 : j)").messages().starts_with("HS0304"));
    assert!(lower("sum(zeros(1000, 2000))").messages().starts_with("HS0304"));
}

#[test]
fn parameters_that_decide_the_structure_are_noted() {
    assert_eq!(lower("q[n]").structural, BTreeSet::from(["n".to_owned()]));
    assert_eq!(lower("sum(j in 1..n where j <> k : q[j])").structural.len(), 2);
    assert_eq!(lower("n*a").structural.len(), 0);
    assert_eq!(lower("inv(J)").structural.len(), 0);
}
