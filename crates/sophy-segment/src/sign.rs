//! The sign of a watch, at a point and just right of it.

/// The sign of a number or of a function just right of an instant.
///
/// Both zeros are `Zero`. NaN has no sign and reads as `Zero` too: engines check that values are finite
/// before they ask for signs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    /// Below zero.
    Negative = -1,
    /// Zero; of a function: identically zero.
    Zero = 0,
    /// Above zero.
    Positive = 1,
}

impl Sign {
    /// The sign of `x`.
    #[must_use]
    #[inline]
    pub fn of(x: f64) -> Self {
        if x > 0.0 {
            Sign::Positive
        } else if x < 0.0 {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }

    /// The other sign; `Zero` stays.
    #[must_use]
    #[inline]
    pub fn opposite(self) -> Self {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }

    /// The sign of the polynomial `Σ c_k s^k` just right of s = 0.
    ///
    /// This is the truth at zero: the limit from the right. The first coefficient that is not zero decides;
    /// if there is none, the polynomial is identically zero and so is its sign. A surface counts as
    /// *exactly* hit only if its coefficient is exactly zero; who knows better (a surface just located, two
    /// sides equal to rounding) sets it to zero first.
    #[must_use]
    #[inline]
    pub fn after(coefficients: &[f64]) -> Self {
        coefficients.iter().map(|&c| Sign::of(c)).find(|&sign| sign != Sign::Zero).unwrap_or(Sign::Zero)
    }
}

#[cfg(test)]
mod tests {
    use super::Sign::{self, Negative, Positive, Zero};

    #[test]
    fn sign_of_a_number() {
        let table = [
            (1.0, Positive),
            (f64::from_bits(1), Positive),
            (f64::INFINITY, Positive),
            (0.0, Zero),
            (-0.0, Zero),
            (f64::NAN, Zero),
            (-f64::from_bits(1), Negative),
            (f64::NEG_INFINITY, Negative),
        ];
        for (x, sign) in table {
            assert_eq!(Sign::of(x), sign, "{x:?}");
            assert_eq!(Sign::of(-x), sign.opposite(), "{x:?}");
        }
    }

    #[test]
    fn sign_right_of_zero() {
        let table: [(&[f64], Sign); 11] = [
            (&[], Zero),
            (&[0.0], Zero),
            (&[-0.0, 0.0, -0.0], Zero),
            (&[2.0, -9.0, -9.0], Positive),
            (&[-2.0, 9.0], Negative),
            (&[0.0, 3.0, -9.0], Positive),
            (&[-0.0, -3.0, 9.0], Negative),
            (&[0.0, -0.0, 1e-300], Positive),
            (&[0.0, 0.0, -1.0], Negative),
            (&[0.0, 0.0, 0.0, -1.0], Negative),
            (&[f64::NAN, 1.0], Positive),
        ];
        for (coefficients, sign) in table {
            assert_eq!(Sign::after(coefficients), sign, "{coefficients:?}");
        }
    }
}
