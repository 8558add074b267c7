//! A page that needs no network: uPlot and the data stand in it.

use std::collections::BTreeMap;

use serde::Serialize;
use sophy_record::{EventRecord, Table};

use super::PlotOptions;
use super::axis::LARGEST;
use super::content::Content;
use super::curve::thinned;
use super::palette;
use super::phase_figure::phase_figure;
use super::text::{escaped, unit};
use crate::FileError;

const TEMPLATE: &str = include_str!("../../assets/page.html");
const STYLE: &str = include_str!("../../assets/page.css");
const SCRIPT: &str = include_str!("../../assets/page.js");
const UPLOT_STYLE: &str = include_str!("../../assets/uPlot.min.css");
const UPLOT_SCRIPT: &str = include_str!("../../assets/uPlot.iife.min.js");
const UPLOT_LICENCE: &str = include_str!("../../assets/LICENSE-uPlot.txt");

/// Rows that a browser draws without delay.
const MOST_ROWS: usize = 60_000;
const MOST_EVENTS: usize = 5_000;

#[derive(Serialize)]
struct Data<'a> {
    time: Vec<f64>,
    panels: Vec<PanelData<'a>>,
    bands: Vec<BandData<'a>>,
    marks: &'a [f64],
    events: Vec<EventData<'a>>,
    events_in_all: usize,
}

#[derive(Serialize)]
struct PanelData<'a> {
    title: String,
    unit: String,
    curves: Vec<CurveData<'a>>,
}

#[derive(Serialize)]
struct CurveData<'a> {
    name: &'a str,
    colour: &'static str,
    dashes: &'static str,
    /// `null` for a value that is no number.
    values: Vec<f64>,
}

#[derive(Serialize)]
struct BandData<'a> {
    name: &'a str,
    names: &'a [String],
    /// Whether its colours stand behind the curves.
    behind: bool,
    colours: Vec<String>,
    shades: Vec<String>,
    /// Start times and locations.
    starts: Vec<f64>,
    locations: Vec<u32>,
}

#[derive(Serialize)]
struct EventData<'a> {
    time: f64,
    component: &'a str,
    transition: &'a str,
    from: &'a str,
    to: &'a str,
}

pub(super) fn page(
    table: &Table,
    content: &Content<'_>,
    events: &[EventRecord],
    options: &PlotOptions,
) -> Result<String, FileError> {
    let entries = &table.metadata.entries;
    let title =
        options.title.as_deref().or(entries.get("model").map(String::as_str)).unwrap_or("Simulation result");
    let rows = chosen_rows(content);
    let phase = match &options.phase {
        Some((horizontal, vertical)) => {
            let sheet = PlotOptions { size: Some((640, 640)), ..PlotOptions::default() };
            phase_figure(table, content, (horizontal, vertical), &sheet, None)?
        }
        None => String::new(),
    };
    let mut notes = Vec::new();
    if rows.len() < table.len() {
        notes.push(format!("Drawn from {} of {} rows; every peak is among them.", rows.len(), table.len()));
    }
    notes.extend(content.note().map(|names| format!("Not shown: {names}.")));
    let data = serde_json::to_string(&data(content, events, &rows));
    // "<" would let a name end the script element.
    let data = data.map_err(FileError::format(std::path::Path::new(title), "JSON"))?.replace('<', "\\u003c");
    let about: String = entries
        .iter()
        .map(|(key, value)| format!("<tr><th>{}</th><td>{}</td></tr>", escaped(key), escaped(value)))
        .collect();
    let tabs = if phase.is_empty() { "" } else { TABS };
    Ok(filled(&[
        ("title", &escaped(title)),
        ("style", &format!("{UPLOT_STYLE}\n{STYLE}")),
        ("tabs", tabs),
        ("about", &about),
        ("phase", &phase),
        ("note", &escaped(&notes.join(" "))),
        ("data", &data),
        ("licence", UPLOT_LICENCE),
        ("uplot", UPLOT_SCRIPT),
        ("script", SCRIPT),
    ]))
}

const TABS: &str = "<nav><button id=\"over-time\" class=\"on\">Over time</button>\
                    <button id=\"in-phase\">Phase portrait</button></nav>";

/// Fills the `{{name}}` of the template in one pass, so that braces in a value stay what they are.
fn filled(values: &[(&str, &str)]) -> String {
    let values: BTreeMap<&str, &str> = values.iter().copied().collect();
    let mut pieces = TEMPLATE.split("{{");
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or((piece, ""));
        out.push_str(values.get(name).copied().unwrap_or_default());
        out.push_str(rest);
    }
    out
}

/// Rows that show: all of them, or of every column of time the extremes of each curve.
fn chosen_rows(content: &Content<'_>) -> Vec<usize> {
    let rows = content.time.len();
    let curves: Vec<&[f64]> =
        content.panels.iter().flat_map(|panel| &panel.curves).map(|curve| curve.values).collect();
    if rows <= MOST_ROWS || curves.is_empty() {
        return (0..rows).collect();
    }
    let columns = MOST_ROWS as f64 / (4.0 * curves.len() as f64);
    let column = (content.time_range.1 - content.time_range.0) / columns;
    let mut kept: Vec<usize> = curves
        .iter()
        .flat_map(|values| {
            thinned(content.time.iter().map(|t| t - content.time_range.0).zip(values.iter().copied()), column)
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

fn data<'a>(content: &'a Content<'a>, events: &'a [EventRecord], rows: &[usize]) -> Data<'a> {
    let picked = |values: &[f64]| -> Vec<f64> {
        rows.iter().map(|&row| if values[row].abs() < LARGEST { values[row] } else { f64::NAN }).collect()
    };
    let panels = content.panels.iter().map(|panel| {
        let unit = panel.unit.map(unit).unwrap_or_default();
        let title = match (panel.name(), unit.as_str()) {
            (name, "") => name.to_owned(),
            ("", unit) => format!("({unit})"),
            (name, unit) => format!("{name} ({unit})"),
        };
        let curves = panel.curves.iter().enumerate().map(|(n, curve)| {
            let (colour, dashes) = palette::curve(n);
            CurveData { name: curve.name, colour, dashes, values: picked(curve.values) }
        });
        PanelData { title, unit, curves: curves.collect() }
    });
    let bands = content.bands.iter().map(|band| {
        let all = 0..band.names.len() as u32;
        BandData {
            name: band.name,
            names: band.names,
            behind: content.automaton().is_some_and(|automaton| automaton.name == band.name),
            colours: all.clone().map(|position| band.colour(position)).collect(),
            shades: all.map(palette::location_shade).collect(),
            starts: band.spans.iter().map(|span| span.0).collect(),
            locations: band.spans.iter().map(|span| span.1).collect(),
        }
    });
    let listed = events.iter().take(MOST_EVENTS).map(|event| EventData {
        time: event.time,
        component: &event.component,
        transition: &event.transition,
        from: &event.from,
        to: &event.to,
    });
    Data {
        time: picked(content.time),
        panels: panels.collect(),
        bands: bands.collect(),
        marks: &content.marks,
        events: listed.collect(),
        events_in_all: events.len(),
    }
}
