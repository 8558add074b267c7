use crate::model::{Interpolation, Table};

/// A table as polynomials, one per knot: from there on to the next knot it is
/// `c₀ + d·(c₁ + d·(c₂ + d·c₃))`, d being the distance from the knot.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Where pieces begin; behind the last one infinity if it has no end.
    pub knots: Vec<f64>,
    /// c₀, c₁ …: one list per coefficient, as many as the interpolation needs.
    pub coefficients: Vec<Vec<f64>>,
}

impl Table {
    /// The polynomials of this table. From its last knot on it is constant.
    pub fn pieces(&self) -> Pieces {
        let mut coefficients = vec![self.values.clone()];
        match self.between {
            Interpolation::Hold => {}
            Interpolation::Linear => coefficients.push(closed(self.slopes())),
            Interpolation::Cubic => {
                let [c1, c2, c3] = self.spline();
                coefficients.extend([closed(c1), closed(c2), closed(c3)]);
            }
        }
        let mut knots = self.knots.clone();
        knots.extend(self.extends.then_some(f64::INFINITY));
        Pieces { knots, coefficients }
    }

    fn widths(&self) -> Vec<f64> {
        self.knots.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    fn slopes(&self) -> Vec<f64> {
        let rises = self.values.windows(2).map(|pair| pair[1] - pair[0]);
        rises.zip(self.widths()).map(|(rise, width)| rise / width).collect()
    }

    /// c₁, c₂ and c₃ of the natural cubic spline: the second derivatives at the knots solve a tridiagonal system, which
    /// is strictly dominated by its diagonal, so that elimination needs no pivots.
    fn spline(&self) -> [Vec<f64>; 3] {
        let (widths, slopes) = (self.widths(), self.slopes());
        let inner = widths.len().saturating_sub(1);
        let (mut diagonal, mut right) = (Vec::with_capacity(inner), Vec::<f64>::with_capacity(inner));
        for (width, slope) in widths.windows(2).zip(slopes.windows(2)) {
            let (mut pivot, mut value) = (2.0 * (width[0] + width[1]), 6.0 * (slope[1] - slope[0]));
            if let (Some(&above), Some(&known)) = (diagonal.last(), right.last()) {
                let factor = width[0] / above;
                pivot -= factor * width[0];
                value -= factor * known;
            }
            diagonal.push(pivot);
            right.push(value);
        }
        // Second derivatives from the last knot to the first, where they are 0.
        let mut seconds = vec![0.0; self.knots.len()];
        for (k, (pivot, value)) in diagonal.iter().zip(&right).enumerate().rev() {
            seconds[k + 1] = (value - widths[k + 1] * seconds[k + 2]) / pivot;
        }
        let pairs = || seconds.windows(2).zip(widths.iter().zip(&slopes));
        [
            pairs().map(|(m, (h, slope))| slope - h * (2.0 * m[0] + m[1]) / 6.0).collect(),
            pairs().map(|(m, _)| m[0] / 2.0).collect(),
            pairs().map(|(m, (h, _))| (m[1] - m[0]) / (6.0 * h)).collect(),
        ]
    }
}

/// With the piece behind the last knot, which is constant.
fn closed(mut coefficients: Vec<f64>) -> Vec<f64> {
    coefficients.push(0.0);
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{locate, lookup};
    use proptest::prelude::*;

    fn value(table: &Table, x: f64) -> f64 {
        let pieces = table.pieces();
        let at = locate(&pieces.knots, x);
        let d = x - lookup(&pieces.knots, at);
        pieces.coefficients.iter().rev().fold(0.0, |sum, c| lookup(c, at) + d * sum)
    }

    fn table(knots: Vec<f64>, values: Vec<f64>, between: Interpolation) -> Table {
        Table { name: "t".to_owned(), knots, values, between, extends: false }
    }

    /// The natural spline by another way: truncated powers `a + b·x + Σ wₖ·|x − xₖ|³` with Σ wₖ = Σ wₖ·xₖ = 0 through
    /// all points, a dense system solved with pivots.
    fn by_kernels(knots: &[f64], values: &[f64], x: f64) -> f64 {
        let n = knots.len();
        let kernel = |a: f64, b: f64| (a - b).abs() * (a - b) * (a - b);
        let mut rows: Vec<Vec<f64>> = (0..n)
            .map(|i| {
                let mut row: Vec<f64> = knots.iter().map(|&k| kernel(knots[i], k)).collect();
                row.extend([1.0, knots[i], values[i]]);
                row
            })
            .collect();
        rows.push(vec![1.0; n].into_iter().chain([0.0, 0.0, 0.0]).collect());
        rows.push(knots.iter().copied().chain([0.0, 0.0, 0.0]).collect());
        let m = n + 2;
        for column in 0..m {
            let pivot = (column..m).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()));
            rows.swap(column, pivot.expect("rows"));
            for row in 0..m {
                if row != column {
                    let factor = rows[row][column] / rows[column][column];
                    let pivot = rows[column].clone();
                    rows[row].iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
                }
            }
        }
        let solved: Vec<f64> = (0..m).map(|i| rows[i][m] / rows[i][i]).collect();
        let sum: f64 = knots.iter().zip(&solved).map(|(&k, w)| w * kernel(x, k)).sum();
        sum + solved[n] + solved[n + 1] * x
    }

    fn points() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
        prop::collection::vec((0.2f64..1.5, -2.0f64..2.0), 3..9).prop_map(|steps| {
            let knots = steps.iter().scan(-1.0, |at, (width, _)| {
                *at += width;
                Some(*at)
            });
            (knots.collect(), steps.iter().map(|(_, value)| *value).collect())
        })
    }

    proptest! {
        #[test]
        fn the_cubic_is_the_natural_spline((knots, values) in points(), part in 0.0f64..1.0) {
            let x = knots[0] + part * (knots[knots.len() - 1] - knots[0]);
            let expected = by_kernels(&knots, &values, x);
            let found = value(&table(knots, values, Interpolation::Cubic), x);
            prop_assert!((found - expected).abs() < 1e-8, "{found} against {expected}");
        }

        #[test]
        fn values_at_knots_are_exact((knots, values) in points()) {
            for between in [Interpolation::Hold, Interpolation::Linear, Interpolation::Cubic] {
                let table = table(knots.clone(), values.clone(), between);
                for (&knot, &expected) in knots.iter().zip(&values) {
                    prop_assert_eq!(value(&table, knot), expected);
                }
            }
        }

        #[test]
        fn a_straight_line_stays_one((knots, _) in points(), part in 0.0f64..1.0) {
            let x = knots[0] + part * (knots[knots.len() - 1] - knots[0]);
            let values: Vec<f64> = knots.iter().map(|k| 2.0 - 3.0 * k).collect();
            for between in [Interpolation::Linear, Interpolation::Cubic] {
                let found = value(&table(knots.clone(), values.clone(), between), x);
                prop_assert!((found - (2.0 - 3.0 * x)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn beyond_the_ends_there_is_nothing_unless_it_extends() {
        let mut held = table(vec![0.0, 1.0], vec![3.0, 5.0], Interpolation::Hold);
        assert_eq!([0.0, 0.5, 1.0].map(|x| value(&held, x)), [3.0, 3.0, 5.0]);
        assert!(value(&held, -0.1).is_nan() && value(&held, 1.1).is_nan());
        held.extends = true;
        assert_eq!([1.0, 7.0].map(|x| value(&held, x)), [5.0, 5.0]);
        assert!(value(&held, -0.1).is_nan());
    }
}
