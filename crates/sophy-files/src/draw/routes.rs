//! Where everything stands: columns and channels from left to right, and the arrows through them.

use super::layers::{Flow, Hop, Item, Layers, Link, layers};
use super::places::heights;

/// An arranged drawing, px. The highest and leftmost things are at 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// Top left corner of every item.
    pub(super) corners: Vec<(f64, f64)>,
    /// Corners of every arrow, from its begin to its end.
    pub(super) routes: Vec<Vec<(f64, f64)>>,
    /// Of every arrow with a label that has room of its own: its middle, on the line.
    pub(super) labels: Vec<Option<(f64, f64)>>,
    pub(super) size: (f64, f64),
}

/// Distance of upright pieces of arrows, px.
const TRACK: f64 = 12.0;
/// Room between a box and the first upright piece: for the head of an arrow.
const LEAD: f64 = 16.0;
/// Heights that differ by less are the same.
const EQUAL: f64 = 1.0;

/// Arranges items and links. `lead_in`: per link, the room it needs where it begins.
pub(super) fn layout(items: &[Item], links: &[Link], flow: Flow, lead_in: &[f64]) -> Layout {
    let mut layers = layers(items, links, flow);
    let y = heights(&mut layers, items, flow);
    let ends = |hop: &Hop| (y[hop.from] + hop.from_offset, y[hop.to] + hop.to_offset);
    let (track, tracks) = tracks(&layers, &ends);

    // Columns.
    let mut leads = vec![0.0_f64; layers.ranks.len() + 1];
    let mut begun = vec![false; links.len()];
    for hop in &layers.hops {
        if !std::mem::replace(&mut begun[hop.link], true) {
            leads[hop.channel] = leads[hop.channel].max(lead_in.get(hop.link).copied().unwrap_or(0.0));
        }
    }
    let mut columns: Vec<(f64, f64)> = Vec::with_capacity(layers.ranks.len());
    let mut channels = Vec::with_capacity(layers.ranks.len() + 1);
    let mut x = 0.0;
    for channel in 0..=layers.ranks.len() {
        let used = layers.hops.iter().any(|hop| hop.channel == channel);
        let edge = channel == 0 || channel == layers.ranks.len();
        let lead = if used || !edge { LEAD } else { 0.0 };
        channels.push(x + lead + leads[channel]);
        x += 2.0 * lead + leads[channel] + TRACK * tracks[channel].saturating_sub(1) as f64;
        if let Some(rank) = layers.ranks.get(channel) {
            let width = rank.iter().map(|&cell| layers.cells[cell].width).fold(0.0, f64::max);
            columns.push((x, width));
            x += width;
        }
    }

    let middle = |cell: usize| {
        let (left, width) = columns[layers.cells[cell].rank];
        left + 0.5 * width
    };
    let corners =
        items.iter().enumerate().map(|(i, item)| (middle(i) - 0.5 * item.width, y[i] - 0.5 * item.height));
    let mut routes = vec![Vec::new(); links.len()];
    let mut labels = vec![None; links.len()];
    for (number, hop) in layers.hops.iter().enumerate() {
        let side = |cell: usize| {
            let half = if cell < items.len() { 0.5 * items[cell].width } else { 0.0 };
            if hop.channel > layers.cells[cell].rank { middle(cell) + half } else { middle(cell) - half }
        };
        let (from, to) = ends(hop);
        let route: &mut Vec<(f64, f64)> = &mut routes[hop.link];
        if hop.from < items.len() {
            route.push((side(hop.from), from));
        } else if layers.cells[hop.from].label {
            labels[hop.link] = Some((middle(hop.from), from));
        }
        // A straight piece keeps the height at which the arrow came.
        let from = route.last().map_or(from, |last| last.1);
        if let Some(track) = track[number] {
            let x = channels[hop.channel] + TRACK * track as f64;
            route.extend([(x, from), (x, to)]);
        }
        if hop.to < items.len() {
            let height = route.last().map_or(to, |last| last.1);
            route.push((side(hop.to), height));
        }
    }
    let bottom = layers.cells.iter().zip(&y).map(|(cell, y)| y + cell.down).fold(0.0, f64::max);
    Layout { corners: corners.collect(), routes, labels, size: (x, bottom) }
}

/// For every hop that is not straight its place among the upright pieces of its channel, and how many places each
/// channel has. Pieces that share a height do not share a place; those that go down are sorted so that they do not
/// cross one another, and so are those that go up.
fn tracks(layers: &Layers, ends: &impl Fn(&Hop) -> (f64, f64)) -> (Vec<Option<usize>>, Vec<usize>) {
    let mut by_channel: Vec<Vec<usize>> = vec![Vec::new(); layers.ranks.len() + 1];
    for (number, hop) in layers.hops.iter().enumerate() {
        let (from, to) = ends(hop);
        if (from - to).abs() >= EQUAL || layers.cells[hop.from].rank == layers.cells[hop.to].rank {
            by_channel[hop.channel].push(number);
        }
    }
    let mut track = vec![None; layers.hops.len()];
    let mut counts = Vec::with_capacity(by_channel.len());
    for (channel, mut hops) in by_channel.into_iter().enumerate() {
        // Height on the left and on the right side of the channel.
        let sides = |hop: usize| {
            let hop = &layers.hops[hop];
            let (from, to) = ends(hop);
            let rank = |cell: usize| layers.cells[cell].rank;
            match (rank(hop.from), rank(hop.to)) {
                (a, b) if a < b => (from, to),
                (a, b) if a > b => (to, from),
                // It turns: both ends are on one side.
                _ => (from, to),
            }
        };
        let turns =
            |hop: usize| layers.cells[layers.hops[hop].from].rank == layers.cells[layers.hops[hop].to].rank;
        hops.sort_by(|&a, &b| {
            let key = |hop: usize| {
                let (left, right) = sides(hop);
                // Turns on the right of their boxes: the short ones inside, and outside of all others.
                if turns(hop) {
                    let nested = (left - right).abs();
                    let inside = channel > layers.cells[layers.hops[hop].from].rank;
                    return (if inside { 3 } else { 0 }, if inside { nested } else { -nested });
                }
                if left < right { (1, -left) } else { (2, left) }
            };
            let (a, b) = (key(a), key(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let mut placed: Vec<(f64, f64, usize)> = Vec::with_capacity(hops.len());
        for hop in hops {
            let (a, b) = sides(hop);
            let (low, high) = (a.min(b) - EQUAL, a.max(b) + EQUAL);
            let meets = placed.iter().filter(|(l, h, _)| low < *h && *l < high);
            let place = meets.map(|(_, _, place)| place + 1).max().unwrap_or(0);
            placed.push((low, high, place));
            track[hop] = Some(place);
        }
        counts.push(placed.iter().map(|(_, _, place)| place + 1).max().unwrap_or(0));
    }
    (track, counts)
}
