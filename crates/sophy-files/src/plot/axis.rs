//! Which numbers stand at an axis.

use super::text;

/// Beyond this a value is drawn as missing; there is no room for arithmetic above it.
pub(super) const LARGEST: f64 = 1e300;

/// A linear axis from `low` to `high` with ticks at multiples of 1, 2 or 5 times a power of ten.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Positions and labels. A label is (value − offset) / 10^exponent.
    pub(super) ticks: Vec<(f64, String)>,
    /// A multiple of three, 0 for numbers of ordinary size.
    pub(super) exponent: i32,
    /// Taken off the labels when the numbers differ only in late digits.
    pub(super) offset: Option<String>,
}

/// Smallest and largest finite value.
pub(super) fn extent<'a>(values: impl IntoIterator<Item = &'a f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|v| v.abs() < LARGEST);
    finite.fold(None, |extent, &v| match extent {
        None => Some((v, v)),
        Some((low, high)) => Some((f64::min(low, v), f64::max(high, v))),
    })
}

/// Room around data: `margin` of its span on both sides; some for a constant or for no data at all.
pub(super) fn range(extent: Option<(f64, f64)>, margin: f64) -> (f64, f64) {
    let (low, high) = extent.unwrap_or((0.0, 0.0));
    let (span, size) = (high - low, f64::max(low.abs(), high.abs()));
    if span > 1e-11 * size && span > 1e-280 {
        (low - margin * span, high + margin * span)
    } else if size > 1e-280 {
        (low - 0.12 * size, high + 0.12 * size)
    } else {
        (-1.2, 1.2)
    }
}

impl Axis {
    /// At most about `count` ticks.
    pub(super) fn new((low, high): (f64, f64), count: f64) -> Self {
        let raw = (high - low) / count.max(1.0);
        let mut decade = libm::floor(libm::log10(raw)) as i32;
        let mut digit = [1.0, 2.0, 5.0].into_iter().find(|d| d * power(decade) >= raw * (1.0 - 1e-9));
        if digit.is_none() {
            decade += 1;
            digit = Some(1.0);
        }
        let step = digit.unwrap_or(1.0) * power(decade);

        let size = f64::max(low.abs(), high.abs());
        let offset =
            (size / step > 2e5).then(|| libm::round(0.5 * (low + high) / (100.0 * step)) * 100.0 * step);
        let base = offset.unwrap_or(0.0);
        let shown = f64::max((low - base).abs(), (high - base).abs());
        let order = libm::floor(libm::log10(shown)) as i32;
        let exponent = if (-2..5).contains(&order) { 0 } else { 3 * order.div_euclid(3) };
        let decimals = usize::try_from(exponent - decade).unwrap_or(0);

        let first = libm::ceil((low - base) / step - 1e-9) as i64;
        let last = libm::floor((high - base) / step + 1e-9) as i64;
        // Dividing by a power keeps 3 × 10⁻¹ at 0.3; multiplying by 0.1 would not.
        let multiple = |k: i64| {
            let digits = k as f64 * digit.unwrap_or(1.0);
            if decade < 0 { digits / power(-decade) } else { digits * power(decade) }
        };
        let label = |value: f64| {
            let scaled = if exponent < 0 { value * power(-exponent) } else { value / power(exponent) };
            let text = format!("{:.*}", decimals, if scaled == 0.0 { 0.0 } else { scaled });
            text.replace('-', "−")
        };
        let ticks = (first..=last).map(|k| (base + multiple(k), label(multiple(k)))).collect();
        let offset = offset.map(|offset| {
            let decimals = usize::try_from(-decade).unwrap_or(0);
            if offset.abs() < 1e9 { format!("{offset:.decimals$}") } else { format!("{offset:e}") }
        });
        Axis { low, high, ticks, exponent, offset }
    }

    /// Where a value stands between the ends of the axis, 0 to 1.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// The title of the axis: name, what is taken off, unit with its power of ten.
    pub(super) fn title(&self, name: &str, unit: Option<&str>) -> String {
        let unit = unit.map(text::unit).filter(|unit| !unit.is_empty());
        let power = (self.exponent != 0).then(|| text::power_of_ten(self.exponent));
        let in_brackets = match (power, unit) {
            (Some(power), Some(unit)) => format!("{power} {unit}"),
            (Some(power), None) => format!("×{power}"),
            (None, Some(unit)) => unit,
            (None, None) => String::new(),
        };
        let mut title = name.to_owned();
        if let Some(offset) = &self.offset {
            let (sign, size) = match offset.strip_prefix('-') {
                Some(size) => ('+', size),
                None => ('−', offset.as_str()),
            };
            title.push_str(&format!(" {sign} {size}"));
        }
        match (title.is_empty(), in_brackets.is_empty()) {
            (_, true) => title,
            (true, false) => format!("({in_brackets})"),
            (false, false) => format!("{title} ({in_brackets})"),
        }
    }
}

fn power(exponent: i32) -> f64 {
    libm::pow(10.0, f64::from(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        Axis::new((low, high), 5.0).ticks.into_iter().map(|tick| tick.1).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(labels(0.0, 20.0), ["0", "5", "10", "15", "20"]);
        assert_eq!(labels(-0.3, 0.7), ["−0.2", "0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(0.0, 6000.0), ["0", "2000", "4000", "6000"]);
    }

    #[test]
    fn very_large_and_very_small_numbers_give_their_power_to_the_title() {
        let large = Axis::new((0.0, 4e6), 5.0);
        assert_eq!((large.exponent, large.ticks[1].1.as_str()), (6, "1"));
        assert_eq!(large.title("work", Some("J")), "work (10⁶ J)");
        let small = Axis::new((0.0, 4e-5), 5.0);
        assert_eq!(small.title("x", None), "x (×10⁻⁶)");
        assert_eq!(small.ticks[1].1, "10");
    }

    #[test]
    fn late_digits_are_shown_from_an_offset() {
        let axis = Axis::new((1e6 + 0.1, 1e6 + 0.5), 5.0);
        assert_eq!(axis.title("x", Some("m")), "x − 1000000.0 (m)");
        assert_eq!(axis.ticks[0].1, "0.1");
    }

    proptest! {
        #[test]
        fn ticks_lie_inside_and_differ(middle in -1e12..1e12f64, span in 1e-9..1e9f64) {
            let (low, high) = range(Some((middle, middle + span)), 0.05);
            let axis = Axis::new((low, high), 6.0);
            prop_assert!((1..=8).contains(&axis.ticks.len()), "{axis:?}");
            let slack = 1e-6 * (high - low);
            prop_assert!(axis.ticks.iter().all(|t| t.0 >= low - slack && t.0 <= high + slack));
            prop_assert!(axis.ticks.windows(2).all(|t| t[0].1 != t[1].1 && t[0].0 < t[1].0), "{axis:?}");
            prop_assert!(axis.ticks.iter().all(|t| t.1.len() < 12), "{axis:?}");
        }
    }
}
