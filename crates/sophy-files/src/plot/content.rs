//! What a picture shows: which variables share a panel, the bands of locations and texts, the marks of transitions.

use std::collections::BTreeSet;

use sophy_record::{Column, ColumnKind, EventRecord, Table};

use super::PlotOptions;
use super::axis::{extent, range};
use super::palette;
use crate::FileError;

/// More panels than this no page holds.
const MOST_PANELS: usize = 6;
/// More curves than this no panel keeps apart.
const MOST_CURVES: usize = 12;
/// More strips than this no page holds.
const MOST_BANDS: usize = 8;

pub(super) struct Content<'a> {
    pub(super) time: &'a [f64],
    /// First and last time; some room around a single row.
    pub(super) time_range: (f64, f64),
    pub(super) panels: Vec<Panel<'a>>,
    pub(super) bands: Vec<Band<'a>>,
    /// Times of transitions, each once, in order.
    pub(super) marks: Vec<f64>,
    /// How many transitions there were, of which several may be at one time.
    pub(super) transitions: usize,
    /// Variables that found no room.
    pub(super) left_out: Vec<&'a str>,
}

/// Curves that share a y axis: they have one unit.
pub(super) struct Panel<'a> {
    pub(super) unit: Option<&'a str>,
    pub(super) curves: Vec<Curve<'a>>,
}

pub(super) struct Curve<'a> {
    pub(super) name: &'a str,
    pub(super) values: &'a [f64],
}

/// The locations of one automaton over time, or a variable whose values are texts or truth values.
pub(super) struct Band<'a> {
    pub(super) name: &'a str,
    pub(super) is_location: bool,
    pub(super) names: &'a [String],
    /// Start time and position in the names; each lasts until the next.
    pub(super) spans: Vec<(f64, u32)>,
}

impl<'a> Content<'a> {
    pub(super) fn new(
        table: &'a Table,
        events: &[EventRecord],
        options: &PlotOptions,
    ) -> Result<Self, FileError> {
        let chosen = chosen_columns(table, options)?;
        let reals: Vec<&Column> = chosen.iter().copied().filter(|c| c.kind == ColumnKind::Real).collect();
        let (panels, mut left_out) = panels(table, &reals);

        let mut bands: Vec<Band<'a>> = chosen.iter().filter_map(|column| band(table, column)).collect();
        if bands.is_empty() {
            let locations = table.schema.columns.iter().filter(|column| column.is_location());
            bands = locations.filter_map(|column| band(table, column)).collect();
        }
        left_out.extend(bands.iter().skip(MOST_BANDS).map(|band| band.name));
        bands.truncate(MOST_BANDS);

        let mut marks: Vec<f64> = events.iter().map(|event| event.time).collect();
        if marks.is_empty() {
            // Without a log the changes of location tell where transitions were.
            let locations = bands.iter().filter(|band| band.is_location);
            marks = locations.flat_map(|band| band.spans.iter().skip(1).map(|span| span.0)).collect();
        }
        let transitions = marks.len();
        marks.sort_by(f64::total_cmp);
        marks.dedup();

        let (first, last) = (table.time.first().copied(), table.time.last().copied());
        let time_range = match (first, last) {
            (Some(first), Some(last)) if last > first => (first, last),
            (Some(only), _) => (only - 0.5, only + 0.5),
            _ => (0.0, 1.0),
        };
        Ok(Content { time: &table.time, time_range, panels, bands, marks, transitions, left_out })
    }

    /// The locations, if they are those of a single automaton.
    pub(super) fn automaton(&self) -> Option<&Band<'a>> {
        let mut locations = self.bands.iter().filter(|band| band.is_location);
        locations.next().filter(|_| locations.next().is_none())
    }

    /// The variables that found no room, in a few words.
    pub(super) fn note(&self) -> Option<String> {
        match self.left_out.as_slice() {
            [] => None,
            [.., last] if self.left_out.len() > 4 => {
                let shown: usize = self.panels.iter().map(|panel| panel.curves.len()).sum();
                let (left, all) = (self.left_out.len(), self.left_out.len() + shown + self.bands.len());
                Some(format!("{left} of {all} variables, {} … {last}", self.left_out[0]))
            }
            few => Some(few.join(", ")),
        }
    }
}

impl Band<'_> {
    /// The colour of a position in the names.
    pub(super) fn colour(&self, position: u32) -> String {
        match self.names.get(position as usize).map(String::as_str) {
            Some("false") => palette::FALSE.to_owned(),
            Some("true") => palette::TRUE.to_owned(),
            _ => palette::location_band(position),
        }
    }
}

impl Panel<'_> {
    /// What to write beside the axis: the one name, or the last part of dotted names if they share it.
    pub(super) fn name(&self) -> &str {
        let mut names = self.curves.iter().map(|curve| curve.name);
        let Some(first) = names.next() else { return "" };
        if self.curves.len() == 1 {
            return first;
        }
        let last_part = |name: &'_ str| name.rfind('.').map_or(0, |dot| dot + 1);
        let shared = &first[last_part(first)..];
        if names.all(|name| &name[last_part(name)..] == shared) { shared } else { "" }
    }

    pub(super) fn range(&self) -> (f64, f64) {
        range(extent(self.curves.iter().flat_map(|curve| curve.values)), 0.05)
    }
}

/// Value of a variable when time reaches `at`: the row before a jump, or on the line between two rows.
pub(super) fn value_before(time: &[f64], values: &[f64], at: f64) -> f64 {
    let next = time.partition_point(|&t| t < at);
    match (next.checked_sub(1), time.get(next)) {
        (_, Some(&t)) if t == at => values[next],
        (Some(before), Some(&t)) => {
            let share = (at - time[before]) / (t - time[before]);
            values[before] + share * (values[next] - values[before])
        }
        _ => f64::NAN,
    }
}

fn chosen_columns<'a>(table: &'a Table, options: &PlotOptions) -> Result<Vec<&'a Column>, FileError> {
    match &options.variables {
        None => Ok(table.schema.columns.iter().collect()),
        Some(names) => names.iter().map(|name| column(table, name)).collect(),
    }
}

/// A column by its name.
pub(super) fn column<'a>(table: &'a Table, name: &str) -> Result<&'a Column, FileError> {
    let found = table.schema.columns.iter().find(|column| column.name == name);
    found.ok_or_else(|| FileError::NoVariable {
        name: name.to_owned(),
        known: table.schema.columns.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "),
    })
}

/// One panel for each unit, in the order of first appearance; variables without unit stand alone while there is
/// room.
fn panels<'a>(table: &'a Table, columns: &[&'a Column]) -> (Vec<Panel<'a>>, Vec<&'a str>) {
    let units: BTreeSet<&str> = columns.iter().filter_map(|c| c.unit.as_deref()).collect();
    let unitless = columns.iter().filter(|c| c.unit.is_none()).count();
    let alone = units.len() + unitless <= MOST_PANELS;
    let mut panels: Vec<Panel<'a>> = Vec::new();
    let mut left_out = Vec::new();
    for column in columns {
        let Some(values) = table.real(&column.name) else { continue };
        let curve = Curve { name: &column.name, values };
        let unit = column.unit.as_deref();
        let shared = panels.iter().position(|p| p.unit == unit && (unit.is_some() || !alone));
        match shared {
            Some(shared) if panels[shared].curves.len() < MOST_CURVES => panels[shared].curves.push(curve),
            None if panels.len() < MOST_PANELS => panels.push(Panel { unit, curves: vec![curve] }),
            _ => left_out.push(column.name.as_str()),
        }
    }
    (panels, left_out)
}

fn band<'a>(table: &'a Table, column: &'a Column) -> Option<Band<'a>> {
    let (positions, names) = table.label(&column.name)?;
    let mut spans: Vec<(f64, u32)> = Vec::new();
    for (&time, &location) in table.time.iter().zip(positions) {
        match spans.last_mut() {
            Some(span) if span.1 == location => {}
            // Several micro-steps of one instant: the last one counts.
            Some(span) if span.0 == time => span.1 = location,
            _ => spans.push((time, location)),
        }
    }
    spans.dedup_by_key(|span| span.1);
    Some(Band { name: &column.name, is_location: column.is_location(), names, spans })
}
