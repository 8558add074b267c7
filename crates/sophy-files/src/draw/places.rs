//! Heights of cells: as near to what they are connected with as their order and their sizes allow.

use super::layers::{Item, Layers};

/// Room between two boxes, two arrows, and an arrow and a box that stand one above the other, px.
const BOX_GAP: f64 = 26.0;
const LANE_GAP: f64 = 14.0;
const SWEEPS: usize = 60;

/// The height of the middle of every cell, px, downwards; the highest top is at 0.
///
/// Rank after rank is moved to the mean of what its cells are connected with: the least squares under the condition
/// that neighbours keep their distance, by pooling adjacent violators. `items`: how many cells are items.
pub(super) fn heights(layers: &Layers, items: usize) -> Vec<f64> {
    let mut y = stacked(layers, items);
    // Per cell: (other cell, by how much its height differs if the arrow is straight, weight).
    let mut pulls: Vec<Vec<(usize, f64, f64)>> = vec![Vec::new(); y.len()];
    for hop in &layers.hops {
        let (a, b) = (hop.from, hop.to);
        if layers.cells[a].rank == layers.cells[b].rank {
            continue;
        }
        let weight = f64::from(1 + u8::from(a >= items) + u8::from(b >= items));
        let straight = hop.from_offset - hop.to_offset;
        pulls[b].push((a, straight, weight));
        pulls[a].push((b, -straight, weight));
    }
    for sweep in 0..SWEEPS {
        for step in 0..layers.ranks.len() {
            let rank = if sweep % 2 == 0 { step } else { layers.ranks.len() - 1 - step };
            let wanted = layers.ranks[rank].iter().map(|&cell| {
                let weight: f64 = pulls[cell].iter().map(|pull| pull.2).sum();
                let sum: f64 = pulls[cell].iter().map(|&(other, by, weight)| weight * (y[other] + by)).sum();
                if weight > 0.0 { (sum / weight, weight) } else { (y[cell], IDLE) }
            });
            let wanted: Vec<(f64, f64)> = wanted.collect();
            settle(layers, items, rank, &wanted, &mut y);
        }
    }
    // The items stay; what passes through follows the arrow, so that it is straight where it can be.
    for (rank, cells) in layers.ranks.iter().enumerate() {
        let follow = |cell: usize| {
            pulls[cell]
                .iter()
                .filter(|&&(other, ..)| layers.cells[other].rank < rank)
                .map(|p| y[p.0] + p.1)
                .next()
        };
        let wanted: Vec<(f64, f64)> = cells
            .iter()
            .map(|&cell| match follow(cell) {
                Some(height) if cell >= items => (height, 1.0),
                _ => (y[cell], STAYS),
            })
            .collect();
        settle(layers, items, rank, &wanted, &mut y);
    }
    let top = layers.cells.iter().zip(&y).map(|(cell, y)| y - cell.up).fold(f64::INFINITY, f64::min);
    y.iter_mut().for_each(|y| *y -= top);
    y
}

/// Moves the ends of arrows along the sides of the items, in their order, so that arrows are straight where they can
/// be. Only where arrows may end anywhere.
pub(super) fn straighten(layers: &mut Layers, items: &[Item], y: &[f64]) {
    // Per item and side: (offset, wanted offset, hop, whether it begins here).
    let mut sides: Vec<[Vec<(f64, f64, usize, bool)>; 2]> = vec![Default::default(); items.len()];
    for (number, hop) in layers.hops.iter().enumerate() {
        let ends = [(true, hop.from, hop.to, hop.from_offset), (false, hop.to, hop.from, hop.to_offset)];
        for (begins, cell, other, offset) in ends {
            if let Some(sides) = sides.get_mut(cell) {
                let turns = layers.cells[cell].rank == layers.cells[other].rank;
                let wanted = if turns { offset } else { y[other] - y[cell] };
                let right = hop.channel > layers.cells[cell].rank;
                sides[usize::from(right)].push((offset, wanted, number, begins));
            }
        }
    }
    for (item, sides) in items.iter().zip(&mut sides) {
        for side in sides {
            side.sort_by(|a, b| a.0.total_cmp(&b.0));
            let most = 0.5 * item.height - CORNER;
            let gap = NEAREST_ENDS.min(2.0 * most / side.len() as f64);
            let mut least = -most;
            for end in side.iter_mut() {
                end.1 = end.1.max(least);
                least = end.1 + gap;
            }
            let mut largest = most;
            for end in side.iter_mut().rev() {
                end.1 = end.1.min(largest);
                largest = end.1 - gap;
                let hop = &mut layers.hops[end.2];
                *(if end.3 { &mut hop.from_offset } else { &mut hop.to_offset }) = end.1;
            }
        }
    }
}

/// Part of a side, at its corners, where no arrow ends, px.
const CORNER: f64 = 12.0;
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
