use super::*;

#[test]
fn units_are_followed() {
    for good in [
        "x + 0.3048*y",
        "x/v + time",
        "x < 2",
        "max(x, 3)",
        "sqrt(x*x) - x",
        "p + [x, 1, 2]",
        "norm(p) < x",
        "z + y",
    ] {
        assert_eq!(lower(good).messages(), "", "{good}");
    }
    let convert = "help: convert one of them, or declare both in one unit";
    let formula = "help: check the formula, and the units of what it uses";
    check(&[
        (
            "x + y",
            &format!(
                "HS0209 x: quantities in `m` and `ft` are added (\"m\") | y: \"ft\" | note: 1 ft = 0.3048 m | {convert}"
            ),
        ),
        (
            "2*x - v",
            &format!(
                "HS0209 2*x: quantities in `m` and `m/s` are subtracted (\"m\") | v: \"m/s\" | {formula}"
            ),
        ),
        (
            "max(x, v)",
            &format!("HS0209 x: `max` gets quantities in `m` and `m/s` (\"m\") | v: \"m/s\" | {formula}"),
        ),
        (
            "if on then x else v",
            &format!(
                "HS0209 x: quantities in `m` and `m/s` are alternatives (\"m\") | v: \"m/s\" | {formula}"
            ),
        ),
        (
            "sin(theta)",
            "HS0209 theta: the argument of `sin` must be a plain number, but is in `deg` (\"deg\") | note: 1 rad = \
             57.2957795 deg | help: convert it first",
        ),
        (
            "z^x",
            "HS0209 x: an exponent must be a plain number, but is in `m` (\"m\") | help: divide it by a quantity in \
             the same unit, or check the formula",
        ),
        (
            "delayed(z, period)",
            &format!(
                "HS0209 period: `period` is in `ms`, but must be in `s` (\"ms\") | note: 1 ms = 0.001 s | {convert}"
            ),
        ),
    ]);
}
