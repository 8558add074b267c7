//! Refinement of a sign change that is already bracketed.

/// The first double at or after the place where `f` turns from positive to zero or negative in (lo, hi].
///
/// `f` counts as positive at `lo` and as turned at `hi`, whatever rounding makes of it there. The bracket is
/// narrowed until its ends are neighbours or nearer than `resolution`; if `f` turns more than once, one of
/// the places is returned.
///
/// Method ITP (I. F. D. Oliveira, R. H. C. Takahashi, *An enhancement of the bisection method average
/// performance preserving minmax optimality*, ACM Trans. Math. Softw. 47, 2020) with κ₁ = 0.2/(hi − lo),
/// κ₂ = 2, n₀ = 1: as fast as the secant rule, at most one step slower than bisection.
pub(super) fn turn(f: &mut impl FnMut(f64) -> f64, lo: f64, hi: f64, resolution: f64) -> f64 {
    let (mut lo, mut hi) = (lo, hi);
    let kappa = 0.2 / (hi - lo);
    let (mut y_lo, mut y_hi) = (f(lo), f(hi));
    // Half the bracket that bisection, started one step earlier, would have.
    let mut allowance = hi - lo;
    loop {
        let half = lo.midpoint(hi);
        if !(lo < half && half < hi) || hi - lo <= resolution {
            return hi;
        }
        let radius = (hi - lo) / 2.0;
        let secant = if y_lo > 0.0 && y_hi <= 0.0 { lo + (hi - lo) * (y_lo / (y_lo - y_hi)) } else { half };
        let toward_half = if half >= secant { 1.0 } else { -1.0 };
        let truncation = (kappa * (hi - lo) * (hi - lo)).max(resolution).max(half.next_up() - half);
        let truncated =
            if truncation <= (half - secant).abs() { secant + toward_half * truncation } else { half };
        let reach = (allowance - radius).max(0.0);
        let candidate =
            if (truncated - half).abs() <= reach { truncated } else { half - toward_half * reach };
        let t = if lo < candidate && candidate < hi { candidate } else { half };
        let y = f(t);
        if y > 0.0 {
            (lo, y_lo) = (t, y);
        } else {
            (hi, y_hi) = (t, y);
        }
        allowance /= 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::turn;
    use std::cell::Cell;

    #[test]
    fn the_first_double_at_or_after_the_turn() {
        for root in [0.1, 1.0 / 3.0, 0.5, 0.999, 1.0] {
            assert_eq!(turn(&mut |t| root - t, 0.0, 1.0, 0.0), root);
            assert_eq!(turn(&mut |t| (root - t) * (1.0 + t) * (2.0 - t), 0.0, 1.0, 0.0), root);
        }
        assert_eq!(turn(&mut |t| -t, -1.0, 3.0, 0.0), 0.0);
    }

    #[test]
    fn few_evaluations_and_never_many_more_than_bisection() {
        let calls = Cell::new(0);
        let count = |y: f64| {
            calls.set(calls.get() + 1);
            y
        };
        turn(&mut |t| count(libm::exp(-t) - 0.3), 0.0, 8.0, 0.0);

        assert!(calls.replace(0) < 24, "smooth");
        turn(&mut |t| count(if t < 0.7 { 1.0 } else { -1e-9 }), 0.0, 1.0, 0.0);
        assert!(calls.replace(0) < 60, "a step");
        turn(&mut |t| count(libm::pow(0.3 - t, 9.0)), 0.0, 1.0, 0.0);
        assert!(calls.get() < 60, "a flat root");
    }
}
