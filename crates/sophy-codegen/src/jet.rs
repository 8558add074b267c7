//! Taylor arithmetic: the coefficients `x⁽ᵏ⁾/k!` of a result from those of its operands, by the recurrences
//! of automatic differentiation (Griewank & Walther, *Evaluating Derivatives*, 2nd ed., ch. 13).
//!
//! `N` coefficients, the value first. Over intervals each coefficient of the result encloses that of every
//! function enclosed by the operands.

use crate::scalar::Scalar;

/// The coefficients of one quantity.
pub(crate) type Jet<T, const N: usize> = [T; N];

fn zeros<T: Scalar, const N: usize>() -> Jet<T, N> {
    [T::of(0.0); N]
}

#[inline]
fn number<T: Scalar>(k: usize) -> T {
    T::of(k as f64)
}

#[inline]
pub(crate) fn multiply<T: Scalar, const N: usize>(a: Jet<T, N>, b: Jet<T, N>) -> Jet<T, N> {
    let mut c = zeros();
    for k in 0..N {
        let mut sum = a[0] * b[k];
        for i in 1..=k {
            sum = sum + a[i] * b[k - i];
        }
        c[k] = sum;
    }
    c
}

/// a², each product once.
#[inline]
pub(crate) fn square<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    let mut c = zeros();
    c[0] = a[0].square();
    for k in 1..N {
        let mut sum = T::of(0.0);
        for i in 0..k.div_ceil(2) {
            sum = sum + a[i] * a[k - i];
        }
        sum = T::of(2.0) * sum;
        if k % 2 == 0 {
            sum = sum + a[k / 2].square();
        }
        c[k] = sum;
    }
    c
}

#[inline]
pub(crate) fn divide<T: Scalar, const N: usize>(a: Jet<T, N>, b: Jet<T, N>) -> Jet<T, N> {
    let mut c = zeros();
    for k in 0..N {
        let mut rest = a[k];
        for i in 1..=k {
            rest = rest - b[i] * c[k - i];
        }
        c[k] = rest / b[0];
    }
    c
}

/// xⁿ by the same chain of products as [`sophy_ir::arithmetic::integer_power`].
pub(crate) fn integer_power<T: Scalar, const N: usize>(a: Jet<T, N>, n: i32) -> Jet<T, N> {
    let mut remaining = n.unsigned_abs();
    let mut power = a;
    let mut product: Option<Jet<T, N>> = None;
    while remaining > 0 {
        if remaining & 1 == 1 {
            product = Some(product.map_or(power, |p| multiply(p, power)));
        }
        remaining >>= 1;
        if remaining > 0 {
            power = square(power);
        }
    }
    let mut one = zeros();
    one[0] = T::of(1.0);
    let mut result = match product {
        None => return one,
        Some(product) if n < 0 => divide(one, product),
        Some(product) => product,
    };
    // Tighter over intervals; the same bits over numbers.
    result[0] = a[0].integer_power(n);
    result
}

#[inline]
pub(crate) fn sqrt<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    let mut c = zeros();
    c[0] = a[0].sqrt();
    for k in 1..N {
        let mut rest = a[k];
        for i in 1..k {
            rest = rest - c[i] * c[k - i];
        }
        // √0 that stays 0 is 0, not 0/0.
        let divided = || [rest / (T::of(2.0) * c[0])];
        let at_zero = || T::choose(rest.equal(T::of(0.0)), || [rest], divided);
        [c[k]] = T::choose(c[0].equal(T::of(0.0)), at_zero, divided);
    }
    c
}

pub(crate) fn exp<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    exp_from(a, a[0].exp())
}

/// e^a, its value given.
fn exp_from<T: Scalar, const N: usize>(a: Jet<T, N>, value: T) -> Jet<T, N> {
    let mut c = zeros();
    c[0] = value;
    for k in 1..N {
        let mut sum = T::of(0.0);
        for i in 1..=k {
            sum = sum + number::<T>(i) * a[i] * c[k - i];
        }
        c[k] = sum / number(k);
    }
    c
}

pub(crate) fn ln<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    let mut c = zeros();
    c[0] = a[0].ln();
    for k in 1..N {
        let mut sum = T::of(0.0);
        for i in 1..k {
            sum = sum + number::<T>(i) * c[i] * a[k - i];
        }
        c[k] = (a[k] - sum / number(k)) / a[0];
    }
    c
}

pub(crate) fn log10<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    let mut c = ln(a);
    for coefficient in c.iter_mut().skip(1) {
        *coefficient = *coefficient / T::of(std::f64::consts::LN_10);
    }
    c[0] = a[0].log10();
    c
}

/// Sine and cosine (`hyperbolic`: sinh and cosh) together.
pub(crate) fn sine_cosine<T: Scalar, const N: usize>(
    a: Jet<T, N>,
    hyperbolic: bool,
) -> (Jet<T, N>, Jet<T, N>) {
    let (mut s, mut c) = (zeros(), zeros());
    (s[0], c[0]) = if hyperbolic { (a[0].sinh(), a[0].cosh()) } else { (a[0].sin(), a[0].cos()) };
    for k in 1..N {
        let (mut ds, mut dc) = (T::of(0.0), T::of(0.0));
        for i in 1..=k {
            let rate = number::<T>(i) * a[i];
            ds = ds + rate * c[k - i];
            dc = dc + rate * s[k - i];
        }
        s[k] = ds / number(k);
        c[k] = if hyperbolic { dc / number(k) } else { -dc / number(k) };
    }
    (s, c)
}

/// tan (`hyperbolic`: tanh): t′ = (1 ± t²)·a′.
pub(crate) fn tangent<T: Scalar, const N: usize>(a: Jet<T, N>, hyperbolic: bool) -> Jet<T, N> {
    let (mut t, mut w): (Jet<T, N>, Jet<T, N>) = (zeros(), zeros());
    t[0] = if hyperbolic { a[0].tanh() } else { a[0].tan() };
    let square = t[0].square();
    w[0] = if hyperbolic { T::of(1.0) - square } else { T::of(1.0) + square };
    for k in 1..N {
        let mut sum = T::of(0.0);
        for i in 1..=k {
            sum = sum + number::<T>(i) * a[i] * w[k - i];
        }
        t[k] = sum / number(k);
        let mut product = T::of(0.0);
        for i in 0..=k {
            product = product + t[i] * t[k - i];
        }
        w[k] = if hyperbolic { -product } else { product };
    }
    t
}

/// y with y′ = a′/r and the given value: all inverse functions.
fn inverse<T: Scalar, const N: usize>(a: Jet<T, N>, r: Jet<T, N>, value: T) -> Jet<T, N> {
    let mut y = zeros();
    y[0] = value;
    for k in 1..N {
        let mut rest = number::<T>(k) * a[k];
        for i in 1..k {
            rest = rest - number::<T>(i) * y[i] * r[k - i];
        }
        y[k] = rest / (number::<T>(k) * r[0]);
    }
    y
}

fn one_plus<T: Scalar, const N: usize>(a: Jet<T, N>, factor: f64, constant: f64) -> Jet<T, N> {
    let mut r = square(a).map(|c| T::of(factor) * c);
    r[0] = T::of(constant) + r[0];
    r
}

pub(crate) fn asin<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    inverse(a, sqrt(one_plus(a, -1.0, 1.0)), a[0].asin())
}

pub(crate) fn acos<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    let mut y = inverse(a, sqrt(one_plus(a, -1.0, 1.0)), a[0].asin()).map(|c| -c);
    y[0] = a[0].acos();
    y
}

pub(crate) fn atan<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    inverse(a, one_plus(a, 1.0, 1.0), a[0].atan())
}

pub(crate) fn asinh<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    inverse(a, sqrt(one_plus(a, 1.0, 1.0)), a[0].asinh())
}

pub(crate) fn acosh<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    inverse(a, sqrt(one_plus(a, 1.0, -1.0)), a[0].acosh())
}

pub(crate) fn atanh<T: Scalar, const N: usize>(a: Jet<T, N>) -> Jet<T, N> {
    inverse(a, one_plus(a, -1.0, 1.0), a[0].atanh())
}

/// atan2(y, x)′ = (x·y′ − y·x′)/(x² + y²).
pub(crate) fn atan2<T: Scalar, const N: usize>(y: Jet<T, N>, x: Jet<T, N>) -> Jet<T, N> {
    let (yy, xx) = (square(y), square(x));
    let r: Jet<T, N> = std::array::from_fn(|k| yy[k] + xx[k]);
    let mut angle = zeros();
    angle[0] = y[0].atan2(x[0]);
    for k in 1..N {
        let mut rest = T::of(0.0);
        for i in 1..=k {
            rest = rest + number::<T>(i) * (y[i] * x[k - i] - x[i] * y[k - i]);
        }
        for i in 1..k {
            rest = rest - number::<T>(i) * angle[i] * r[k - i];
        }
        angle[k] = rest / (number::<T>(k) * r[0]);
    }
    angle
}

/// aᵖ with a constant exponent: a·c′ = p·a′·c; at a = 0, where that divides by zero, Taylor's formula.
pub(crate) fn power_constant<T: Scalar, const N: usize>(a: Jet<T, N>, p: T) -> Jet<T, N> {
    let value = a[0].pow(p);
    T::choose(a[0].equal(T::of(0.0)), || power_at_zero(a, p, value), || power_elsewhere(a, p, value))
}

fn power_elsewhere<T: Scalar, const N: usize>(a: Jet<T, N>, p: T, value: T) -> Jet<T, N> {
    let mut c = zeros();
    c[0] = value;
    for k in 1..N {
        let mut sum = T::of(0.0);
        for i in 1..=k {
            sum = sum + (p * number(i) - number(k - i)) * a[i] * c[k - i];
        }
        c[k] = sum / (number::<T>(k) * a[0]);
    }
    c
}

fn power_at_zero<T: Scalar, const N: usize>(a: Jet<T, N>, p: T, value: T) -> Jet<T, N> {
    // An infinite slope times nothing is nothing.
    let times = |factor: T, x: T| T::choose(x.equal(T::of(0.0)), || [x], || [factor * x])[0];
    let mut c = zeros();
    c[0] = value;
    let slope = p * a[0].pow(p - T::of(1.0));
    let derivative = |factor: T, n: f64| {
        T::choose(factor.equal(T::of(0.0)), || [factor], || [factor * a[0].pow(p - T::of(n))])[0]
    };
    for k in 1..N {
        let mut bend = T::of(0.0);
        if k > 1 {
            let factor = p * (p - T::of(1.0)) / T::of(2.0);
            let products = if k == 2 { a[1].square() } else { T::of(2.0) * (a[1] * a[2]) };
            bend = times(derivative(factor, 2.0), products);
        }
        if k > 2 {
            let factor = p * (p - T::of(1.0)) * (p - T::of(2.0)) / T::of(6.0);
            bend = bend + times(derivative(factor, 3.0), a[1].square() * a[1]);
        }
        c[k] = times(slope, a[k]) + bend;
    }
    c
}

/// aᵇ = e^(b·ln a).
pub(crate) fn power<T: Scalar, const N: usize>(a: Jet<T, N>, b: Jet<T, N>) -> Jet<T, N> {
    let value = a[0].pow(b[0]);
    exp_from(multiply(b, ln(a)), value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of f(a(t)) by evaluating f on a(t) = x + v t + w t² at small t, for comparison.
    fn check(jet: impl Fn(Jet<f64, 3>) -> Jet<f64, 3>, f: impl Fn(f64) -> f64, x: f64) {
        let a = [x, 0.7, -0.4];
        let along = |t: f64| f(a[0] + t * (a[1] + t * a[2]));
        let h = 1e-4;
        let first = (along(h) - along(-h)) / (2.0 * h);
        let second = (along(h) - 2.0 * along(0.0) + along(-h)) / (2.0 * h * h);
        let c = jet(a);
        assert!((c[0] - along(0.0)).abs() <= 1e-15 * along(0.0).abs().max(1.0), "{c:?}");
        assert!((c[1] - first).abs() < 1e-6 * (1.0 + first.abs()), "{c:?} {first}");
        assert!((c[2] - second).abs() < 1e-5 * (1.0 + second.abs()), "{c:?} {second}");
    }

    #[test]
    fn powers_have_derivatives_at_zero() {
        assert_eq!(power_constant([0.0, 2.0, 3.0], 2.5), [0.0, 0.0, 0.0]);
        assert_eq!(power_constant([0.0, 2.0], 1.5), [0.0, 0.0]);
        assert_eq!(power_constant([0.0, 2.0, 3.0], 1.0), [0.0, 2.0, 3.0]);
        assert_eq!(power_constant([0.0, 2.0, 3.0, 5.0], 1.0), [0.0, 2.0, 3.0, 5.0]);
        assert_eq!(power_constant([0.0, 2.0, 3.0, 5.0], 2.0), [0.0, 0.0, 4.0, 12.0]);
        assert_eq!(power_constant([0.0, 2.0, 3.0, 5.0], 3.0), [0.0, 0.0, 0.0, 8.0]);
        assert_eq!(power_constant([0.0, 2.0, 3.0, 5.0], 3.5), [0.0; 4]);
    }

    #[test]
    fn recurrences_agree_with_differences() {
        check(exp, libm::exp, 0.3);
        check(ln, libm::log, 0.6);
        check(log10, libm::log10, 0.6);
        check(sqrt, f64::sqrt, 0.6);
        check(|a| sine_cosine(a, false).0, libm::sin, 0.3);
        check(|a| sine_cosine(a, false).1, libm::cos, 0.3);
        check(|a| sine_cosine(a, true).0, libm::sinh, 0.3);
        check(|a| sine_cosine(a, true).1, libm::cosh, 0.3);
        check(|a| tangent(a, false), libm::tan, 0.3);
        check(|a| tangent(a, true), libm::tanh, 0.3);
        check(asin, libm::asin, 0.3);
        check(acos, libm::acos, 0.3);
        check(atan, libm::atan, 0.3);
        check(asinh, libm::asinh, 0.3);
        check(acosh, libm::acosh, 1.9);
        check(atanh, libm::atanh, 0.3);
        check(square, |x| x * x, 0.3);
        check(|a| integer_power(a, 5), |x| x * x * x * x * x, 0.7);
        check(|a| integer_power(a, -3), |x| 1.0 / (x * x * x), 0.7);
        check(|a| power_constant(a, 1.7), |x| libm::pow(x, 1.7), 0.7);
        check(|a| power(a, [a[0] * 2.0, a[1] * 2.0, a[2] * 2.0]), |x| libm::pow(x, 2.0 * x), 0.7);
        check(|a| atan2(a, square(a)), |x| libm::atan2(x, x * x), 0.7);
        check(|a| divide(a, exp(a)), |x| x / libm::exp(x), 0.7);
        check(|a| multiply(a, exp(a)), |x| x * libm::exp(x), 0.7);
    }
}
