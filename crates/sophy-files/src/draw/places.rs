//! Heights of cells: as near to what they are connected with as their order and their sizes allow.

use super::layers::{End, Flow, Item, Layers};

/// Room between two boxes, two arrows, and an arrow and a box that stand one above the other, px.
const BOX_GAP: f64 = 26.0;
const LANE_GAP: f64 = 14.0;
const SWEEPS: usize = 60;
/// Rounds in which labels and ends of arrows settle.
const ROUNDS: usize = 24;

/// The height of the middle of every cell, px, downwards; the highest top is at 0.
///
/// Rank after rank is moved to the mean of what its cells are connected with: the least squares under the condition
/// that neighbours keep their distance, by pooling adjacent violators. Where arrows may end anywhere, their ends are
/// then moved along the sides of the items, too.
pub(super) fn heights(layers: &mut Layers, items: &[Item], flow: Flow) -> Vec<f64> {
    let mut y = stacked(layers, items.len());
    let connected = connected(layers);
    for sweep in 0..SWEEPS {
        relax(layers, items.len(), &connected, sweep % 2 == 0, true, &mut y);
    }
    for round in 0..ROUNDS {
        if flow == Flow::Around {
            straighten(layers, items, &y);
        }
        relax(layers, items.len(), &connected, round % 2 == 0, round < ROUNDS / 2, &mut y);
    }
    // At last what passes through follows the arrow from the left, so that it is straight where it can be.
    for rank in 0..layers.ranks.len() {
        let from_left =
            |cell: usize| connected[cell].iter().find(|&&hop| layers.other_rank(hop, cell) < rank);
        let wanted = |&cell: &usize| match from_left(cell) {
            Some(&hop) if cell >= items.len() => (straight(layers, hop, cell, &y), 1.0),
            _ => (y[cell], STAYS),
        };
        let wanted: Vec<(f64, f64)> = layers.ranks[rank].iter().map(wanted).collect();
        settle(layers, items.len(), rank, &wanted, &mut y);
    }
    if flow == Flow::Around {
        straighten(layers, items, &y);
    }
    let top = layers.cells.iter().zip(&y).map(|(cell, y)| y - cell.up).fold(f64::INFINITY, f64::min);
    y.iter_mut().for_each(|y| *y -= top);
    y
}

/// The hops of every cell that lead to other ranks.
fn connected(layers: &Layers) -> Vec<Vec<usize>> {
    let mut connected: Vec<Vec<usize>> = vec![Vec::new(); layers.cells.len()];
    for (number, hop) in layers.hops.iter().enumerate() {
        if layers.cells[hop.from].rank != layers.cells[hop.to].rank {
            connected[hop.from].push(number);
            connected[hop.to].push(number);
        }
    }
    connected
}

/// The height of a cell at which a hop is straight.
fn straight(layers: &Layers, hop: usize, cell: usize, y: &[f64]) -> f64 {
    let hop = &layers.hops[hop];
    if cell == hop.to {
        y[hop.from] + hop.from_offset - hop.to_offset
    } else {
        y[hop.to] + hop.to_offset - hop.from_offset
    }
}

/// Moves all cells, or only those that arrows pass through, towards what they are connected with.
fn relax(
    layers: &Layers,
    items: usize,
    connected: &[Vec<usize>],
    rightwards: bool,
    all: bool,
    y: &mut [f64],
) {
    for step in 0..layers.ranks.len() {
        let rank = if rightwards { step } else { layers.ranks.len() - 1 - step };
        let wanted = |&cell: &usize| {
            if !all && cell < items {
                return (y[cell], STAYS);
            }
            let (mut sum, mut weights) = (0.0, 0.0);
            for &hop in &connected[cell] {
                let (from, to) = (layers.hops[hop].from, layers.hops[hop].to);
                let weight = f64::from(1 + u8::from(from >= items) + u8::from(to >= items));
                sum += weight * straight(layers, hop, cell, y);
                weights += weight;
            }
            if weights > 0.0 { (sum / weights, weights) } else { (y[cell], IDLE) }
        };
        let wanted: Vec<(f64, f64)> = layers.ranks[rank].iter().map(wanted).collect();
        settle(layers, items, rank, &wanted, y);
    }
}

/// Moves the ends of arrows along the sides of the items, in their order, so that arrows are straight where they can
/// be. Only where arrows may end anywhere.
fn straighten(layers: &mut Layers, items: &[Item], y: &[f64]) {
    for (number, sides) in layers.sides(items.len()).into_iter().enumerate() {
        for side in sides {
            let mut ends: Vec<(f64, End)> = side.into_iter().map(|end| (*layers.offset(&end), end)).collect();
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            let most = 0.5 * items[number].height - CORNER;
            let gap = NEAREST_ENDS.min(2.0 * most / ends.len() as f64);
            let mut least = -most;
            for (offset, end) in &mut ends {
                let wanted = if end.turns { *offset } else { y[end.other] - y[number] };
                *offset = wanted.max(least);
                least = *offset + gap;
            }
            let mut largest = most;
            for (offset, end) in ends.iter().rev() {
                *layers.offset(end) = offset.min(largest);
                largest = offset.min(largest) - gap;
            }
        }
    }
}

/// Part of a side, at its corners, where no arrow ends, px.
const CORNER: f64 = 10.0;
/// Least distance of two arrows at a side, px.
const NEAREST_ENDS: f64 = 14.0;

/// Weight of a cell that nothing pulls.
const IDLE: f64 = 0.05;
/// Weight of a cell that is not to move.
const STAYS: f64 = 1e6;

/// How far the middles of two cells, one above the other, are apart at least.
fn distance(layers: &Layers, items: usize, above: usize, below: usize) -> f64 {
    let gap = if above < items && below < items { BOX_GAP } else { LANE_GAP };
    layers.cells[above].down + gap + layers.cells[below].up
}

fn stacked(layers: &Layers, items: usize) -> Vec<f64> {
    let mut y = vec![0.0; layers.cells.len()];
    for rank in &layers.ranks {
        let mut last: Option<usize> = None;
        for &cell in rank {
            y[cell] = last.map_or(0.0, |above| y[above] + distance(layers, items, above, cell));
            last = Some(cell);
        }
        let middle = last.map_or(0.0, |cell| 0.5 * y[cell]);
        rank.iter().for_each(|&cell| y[cell] -= middle);
    }
    y
}

/// Puts the cells of a rank where they want to be (height, weight), at their distances.
fn settle(layers: &Layers, items: usize, rank: usize, wanted: &[(f64, f64)], y: &mut [f64]) {
    let cells = &layers.ranks[rank];
    // Blocks of cells that touch: (weighted sum, weight, number of cells), heights counted from the stack.
    let mut blocks: Vec<(f64, f64, usize)> = Vec::with_capacity(cells.len());
    let mut stack = Vec::with_capacity(cells.len());
    let mut depth = 0.0;
    for (place, (&cell, &(height, weight))) in cells.iter().zip(wanted).enumerate() {
        if place > 0 {
            depth += distance(layers, items, cells[place - 1], cell);
        }
        stack.push(depth);
        let mut block = (weight * (height - depth), weight, 1);
        while let Some(&(sum, weight, count)) = blocks.last() {
            if sum / weight < block.0 / block.1 {
                break;
            }
            block = (block.0 + sum, block.1 + weight, block.2 + count);
            blocks.pop();
        }
        blocks.push(block);
    }
    let heights = blocks.iter().flat_map(|&(sum, weight, count)| std::iter::repeat_n(sum / weight, count));
    for ((&cell, depth), height) in cells.iter().zip(stack).zip(heights) {
        y[cell] = height + depth;
    }
}
