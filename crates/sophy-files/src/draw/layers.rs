//! Ranks from left to right, and the order of what shares a rank.
//!
//! An arrow that spans several ranks passes through a *cell* in each of them; the label of an arrow is the size of
//! one of its cells. An arrow of a composition that runs backwards, and every loop, turns round under its boxes: it
//! has cells in the ranks of both ends, too.

use std::collections::VecDeque;

/// What is to be placed.
#[derive(Clone, Debug, Default)]
pub(super) struct Item {
    pub(super) width: f64,
    pub(super) height: f64,
    /// More room that is needed above.
    pub(super) head: f64,
    pub(super) at: Pin,
    /// Heights of the ports on the left and right side, from the middle; empty if arrows may end anywhere.
    pub(super) left: Vec<f64>,
    pub(super) right: Vec<f64>,
}

/// Where an item has to be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Pin {
    #[default]
    Free,
    First,
    Last,
}

/// An arrow to be led.
#[derive(Clone, Debug, Default)]
pub(super) struct Link {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) from_port: Option<usize>,
    pub(super) to_port: Option<usize>,
    pub(super) width: f64,
    /// Height of the label above and under the line.
    pub(super) above: f64,
    pub(super) below: f64,
}

/// How arrows run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flow {
    /// Between the sides that face one another; labels have ranks of their own.
    Around,
    /// Out of the right side, into the left side.
    Onward,
}

/// An item, or the place where an arrow passes through a rank.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) rank: usize,
    pub(super) width: f64,
    /// Room above and under the middle (of a label: the line).
    pub(super) up: f64,
    pub(super) down: f64,
    /// The cell that it follows in its rank, whatever the rest does.
    host: Option<usize>,
    /// Whether it stays under the others of its rank.
    bottom: bool,
    /// Whether it carries a label.
    pub(super) label: bool,
}

/// A piece of an arrow between two cells, through the channel on the left of rank `channel`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hop {
    pub(super) link: usize,
    pub(super) channel: usize,
    pub(super) from: usize,
    pub(super) to: usize,
    /// Heights of its ends, from the middles of the cells.
    pub(super) from_offset: f64,
    pub(super) to_offset: f64,
}

/// Where a hop meets an item.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub(super) hop: usize,
    /// Whether the hop begins here.
    pub(super) begins: bool,
    /// Whether it turns round in the channel.
    pub(super) turns: bool,
    /// The cell at its other end.
    pub(super) other: usize,
}

/// Ranks and their order.
#[derive(Clone, Debug, Default)]
pub(super) struct Layers {
    /// The first cells are the items.
    pub(super) cells: Vec<Cell>,
    /// By link and in its direction.
    pub(super) hops: Vec<Hop>,
    /// Cells rank by rank, from top to bottom.
    pub(super) ranks: Vec<Vec<usize>>,
}

/// Arranges items in ranks.
pub(super) fn layers(items: &[Item], links: &[Link], flow: Flow) -> Layers {
    let ranks = match flow {
        Flow::Around => {
            longest_paths(items.len(), &around(items.len(), links)).iter().map(|r| 2 * r).collect()
        }
        Flow::Onward => pinned(items, links),
    };
    let mut layers = Layers { cells: items.iter().zip(&ranks).map(item_cell).collect(), ..Layers::default() };
    // What no arrow meets stands under the rest.
    let mut lonely = vec![true; items.len()];
    links.iter().flat_map(|link| [link.from, link.to]).for_each(|item| lonely[item] = false);
    layers.cells.iter_mut().zip(lonely).for_each(|(cell, lonely)| cell.bottom = lonely);
    for (number, link) in links.iter().enumerate() {
        layers.lead(number, link, items, flow);
    }
    let count = layers.cells.iter().map(|cell| cell.rank + 1).max().unwrap_or(0);
    layers.ranks = vec![Vec::new(); count];
    for (number, cell) in layers.cells.iter().enumerate() {
        if let Some(rank) = layers.ranks.get_mut(cell.rank) {
            rank.push(number);
        }
    }
    layers.order();
    if flow == Flow::Around {
        layers.spread(items);
    }
    layers
}

fn item_cell((item, &rank): (&Item, &usize)) -> Cell {
    let (up, down) = (0.5 * item.height + item.head, 0.5 * item.height);
    Cell { rank, width: item.width, up, down, host: None, bottom: false, label: false }
}

/// The arrows as pairs from nearer to farther, seen from the first item without regard to direction: a ring becomes
/// two branches that meet, not a chain with one long way back.
fn around(items: usize, links: &[Link]) -> Vec<(usize, usize)> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); items];
    for link in links {
        neighbours[link.from].push(link.to);
        neighbours[link.to].push(link.from);
    }
    let (mut distance, mut found) = (vec![usize::MAX; items], vec![usize::MAX; items]);
    let mut next = 0;
    for start in 0..items {
        if distance[start] != usize::MAX {
            continue;
        }
        distance[start] = 0;
        let mut queue = VecDeque::from([start]);
        while let Some(item) = queue.pop_front() {
            found[item] = next;
            next += 1;
            for &other in &neighbours[item] {
                if distance[other] == usize::MAX {
                    distance[other] = distance[item] + 1;
                    queue.push_back(other);
                }
            }
        }
    }
    let key = |item: usize| (distance[item], found[item]);
    let ends = links.iter().filter(|link| link.from != link.to).map(|link| (link.from, link.to));
    ends.map(|(a, b)| if key(a) < key(b) { (a, b) } else { (b, a) }).collect()
}

/// The length of the longest path to each item; `arcs` have no circle.
fn longest_paths(items: usize, arcs: &[(usize, usize)]) -> Vec<usize> {
    let (mut successors, mut waiting) = (vec![Vec::new(); items], vec![0_usize; items]);
    for &(from, to) in arcs {
        successors[from].push(to);
        waiting[to] += 1;
    }
    let mut rank = vec![0; items];
    let mut ready: Vec<usize> = (0..items).filter(|&item| waiting[item] == 0).collect();
    while let Some(item) = ready.pop() {
        for &to in &successors[item] {
            rank[to] = rank[to].max(rank[item] + 1);
            waiting[to] -= 1;
            if waiting[to] == 0 {
                ready.push(to);
            }
        }
    }
    rank
}

/// Ranks along the flow, pinned items in the first and last one.
fn pinned(items: &[Item], links: &[Link]) -> Vec<usize> {
    let arcs = forward(items, links);
    let mut ranks = longest_paths(items.len(), &arcs);
    // A source stands beside what it feeds first, not at the far left.
    let mut nearest = vec![usize::MAX; items.len()];
    let mut fed = vec![false; items.len()];
    for &(from, to) in &arcs {
        nearest[from] = nearest[from].min(ranks[to]);
        fed[to] = true;
    }
    for item in 0..items.len() {
        if !fed[item] && nearest[item] != usize::MAX {
            ranks[item] = nearest[item].saturating_sub(1);
        }
    }
    let free = |item: &usize| items[*item].at == Pin::Free;
    let least = (0..items.len()).filter(free).map(|item| ranks[item]).min().unwrap_or(0);
    let before = usize::from(items.iter().any(|item| item.at == Pin::First));
    for rank in &mut ranks {
        *rank = (*rank).saturating_sub(least) + before;
    }
    let last = (0..items.len()).filter(free).map(|item| ranks[item] + 1).max().unwrap_or(before);
    for (item, rank) in items.iter().zip(&mut ranks) {
        match item.at {
            Pin::First => *rank = 0,
            Pin::Last => *rank = last,
            Pin::Free => {}
        }
    }
    ranks
}

/// The arrows that close no circle, found in depth from the inputs, then in written order.
fn forward(items: &[Item], links: &[Link]) -> Vec<(usize, usize)> {
    let mut successors: Vec<Vec<usize>> = vec![Vec::new(); items.len()];
    for link in links {
        successors[link.from].push(link.to);
    }
    let mut kept = Vec::new();
    // 0 unseen, 1 on the path, 2 done.
    let mut state = vec![0_u8; items.len()];
    let inputs = (0..items.len()).filter(|&item| items[item].at == Pin::First);
    for start in inputs.chain(0..items.len()) {
        if state[start] != 0 {
            continue;
        }
        state[start] = 1;
        let mut path = vec![(start, 0_usize)];
        while let Some((item, next)) = path.last_mut() {
            let (from, position) = (*item, *next);
            *next += 1;
            match successors[from].get(position) {
                None => {
                    state[from] = 2;
                    path.pop();
                }
                Some(&to) => {
                    if state[to] != 1 {
                        kept.push((from, to));
                    }
                    if state[to] == 0 {
                        state[to] = 1;
                        path.push((to, 0));
                    }
                }
            }
        }
    }
    kept
}

impl Layers {
    /// Makes the cells and hops of an arrow.
    fn lead(&mut self, number: usize, link: &Link, items: &[Item], flow: Flow) {
        let (source, target) = (self.cells[link.from].rank, self.cells[link.to].rank);
        let turns = link.from == link.to || (flow == Flow::Onward && source >= target);
        let between: Vec<usize> = if turns {
            (target..=source).rev().collect()
        } else if source < target {
            (source + 1..target).collect()
        } else {
            (target + 1..source).rev().collect()
        };
        // Seen from the end where it begins the 1st, 3rd … cell of an automaton's arrow is in a rank for labels.
        let labelled = (between.len() / 2) & !1;
        let mut at = link.from;
        for (position, &rank) in between.iter().enumerate() {
            let label = position == labelled;
            let (up, down) = if label { (link.above, link.below) } else { (0.0, 0.0) };
            let host = (link.from == link.to).then_some(link.from);
            let width = if label { link.width } else { 0.0 };
            let (bottom, label) = (turns && host.is_none(), label && link.width > 0.0);
            self.cells.push(Cell { rank, width, up, down, host, bottom, label });
            let next = self.cells.len() - 1;
            let channel = if turns || source > target { rank + 1 } else { rank };
            self.hop(number, channel, at, next);
            at = next;
        }
        let channel = if turns || source < target { target } else { target + 1 };
        let first = self.hops.len() - between.len();
        self.hop(number, channel, at, link.to);
        let port =
            |heights: &[f64], port: Option<usize>| port.and_then(|p| heights.get(p)).copied().unwrap_or(0.0);
        self.hops[first].from_offset = port(&items[link.from].right, link.from_port);
        if let Some(last) = self.hops.last_mut() {
            last.to_offset = port(&items[link.to].left, link.to_port);
        }
    }

    fn hop(&mut self, link: usize, channel: usize, from: usize, to: usize) {
        self.hops.push(Hop { link, channel, from, to, from_offset: 0.0, to_offset: 0.0 });
    }

    /// Orders every rank so that few arrows cross: the mean of the neighbours, from left to right and back, and the
    /// best that was seen.
    fn order(&mut self) {
        self.ranks.iter_mut().for_each(|rank| rank.sort_by_key(|&cell| self.cells[cell].bottom));
        let mut best = (usize::MAX, self.ranks.clone());
        for sweep in 0..=SWEEPS {
            let position = self.positions();
            let crossings = self.crossings(&position);
            if crossings < best.0 {
                best = (crossings, self.ranks.clone());
            }
            if crossings == 0 || sweep == SWEEPS {
                break;
            }
            self.sweep(sweep % 2 == 0);
        }
        self.ranks = best.1;
        self.follow_hosts();
    }

    fn positions(&self) -> Vec<f64> {
        let mut position = vec![0.0; self.cells.len()];
        for rank in &self.ranks {
            for (place, &cell) in rank.iter().enumerate() {
                position[cell] = place as f64;
            }
        }
        position
    }

    /// The rank of the other end of a hop.
    pub(super) fn other_rank(&self, hop: usize, cell: usize) -> usize {
        let hop = &self.hops[hop];
        self.cells[if hop.from == cell { hop.to } else { hop.from }].rank
    }

    /// How far from its middle a hop meets a cell, as a share of its height.
    fn share(&self, hop: &Hop, cell: usize) -> f64 {
        let offset = if cell == hop.from { hop.from_offset } else { hop.to_offset };
        offset / (self.cells[cell].up + self.cells[cell].down + 1.0)
    }

    fn sweep(&mut self, rightwards: bool) {
        let mut sums = vec![(0.0, 0.0); self.cells.len()];
        let count = self.ranks.len();
        let mut by_rank: Vec<Vec<(usize, f64, usize)>> = vec![Vec::new(); count];
        for hop in &self.hops {
            let (a, b) = (hop.from, hop.to);
            let (a, b) = if self.cells[a].rank < self.cells[b].rank { (a, b) } else { (b, a) };
            if self.cells[a].rank != self.cells[b].rank {
                let (fixed, moved) = if rightwards { (a, b) } else { (b, a) };
                by_rank[self.cells[moved].rank].push((
                    fixed,
                    self.share(hop, fixed) - self.share(hop, moved),
                    moved,
                ));
            }
        }
        let mut position = self.positions();
        for step in 0..count {
            let rank = if rightwards { step } else { count - 1 - step };
            for &(fixed, share, moved) in &by_rank[rank] {
                sums[moved].0 += position[fixed] + share;
                sums[moved].1 += 1.0;
            }
            let key = |cell: usize| match sums[cell] {
                (_, 0.0) => position[cell],
                (sum, weight) => sum / weight,
            };
            let mut ordered = self.ranks[rank].clone();
            let bottom = |cell: usize| self.cells[cell].bottom;
            ordered.sort_by(|&a, &b| bottom(a).cmp(&bottom(b)).then(key(a).total_cmp(&key(b))));
            for (place, &cell) in ordered.iter().enumerate() {
                position[cell] = place as f64;
            }
            self.ranks[rank] = ordered;
        }
    }

    /// The number of crossings between neighbouring ranks; of very large drawings, none.
    fn crossings(&self, position: &[f64]) -> usize {
        let mut by_channel: Vec<Vec<(f64, f64)>> = vec![Vec::new(); self.ranks.len() + 1];
        for hop in &self.hops {
            let (a, b) = (&self.cells[hop.from], &self.cells[hop.to]);
            let end = |cell: usize| position[cell] + self.share(hop, cell);
            let (from, to) = (end(hop.from), end(hop.to));
            if a.rank != b.rank {
                by_channel[hop.channel].push(if a.rank < b.rank { (from, to) } else { (to, from) });
            }
        }
        let crossing = |hops: &Vec<(f64, f64)>| {
            let pairs = hops.iter().enumerate().flat_map(|(i, a)| hops[..i].iter().map(move |b| (a, b)));
            pairs.filter(|(a, b)| (a.0 - b.0) * (a.1 - b.1) < 0.0).count()
        };
        by_channel.iter().filter(|hops| hops.len() < MOST_COUNTED).map(crossing).sum()
    }

    fn follow_hosts(&mut self) {
        let mut guests: Vec<Vec<usize>> = vec![Vec::new(); self.cells.len()];
        for (number, cell) in self.cells.iter().enumerate() {
            if let Some(host) = cell.host {
                guests[host].push(number);
            }
        }
        for rank in &mut self.ranks {
            let free = rank.iter().filter(|&&cell| self.cells[cell].host.is_none());
            *rank =
                free.flat_map(|&cell| std::iter::once(cell).chain(guests[cell].iter().copied())).collect();
        }
    }

    /// Spreads the arrows of every item over its two sides, in the order of where they come from.
    fn spread(&mut self, items: &[Item]) {
        let position = self.positions();
        for (item, sides) in items.iter().zip(self.sides(items.len())) {
            for mut side in sides {
                // Of loops the outermost, which ends lowest, begins highest: so they do not cross.
                let height = |end: &End| if end.turns { -position[end.other] } else { position[end.other] };
                side.sort_by(|a, b| a.turns.cmp(&b.turns).then(height(a).total_cmp(&height(b))));
                let step = (item.height / (side.len() + 1) as f64).min(WIDEST_STEP);
                for (place, end) in side.iter().enumerate() {
                    *self.offset(end) = (place as f64 - 0.5 * (side.len() - 1) as f64) * step;
                }
            }
        }
    }

    /// The ends of arrows at the left and the right side of every item, in written order.
    pub(super) fn sides(&self, items: usize) -> Vec<[Vec<End>; 2]> {
        let mut sides: Vec<[Vec<End>; 2]> = vec![Default::default(); items];
        for (number, hop) in self.hops.iter().enumerate() {
            for (begins, cell, other) in [(true, hop.from, hop.to), (false, hop.to, hop.from)] {
                if let Some(sides) = sides.get_mut(cell) {
                    let turns = self.cells[cell].rank == self.cells[other].rank;
                    let right = hop.channel > self.cells[cell].rank;
                    sides[usize::from(right)].push(End { hop: number, begins, turns, other });
                }
            }
        }
        sides
    }

    /// The height of an end, from the middle of its item.
    pub(super) fn offset(&mut self, end: &End) -> &mut f64 {
        let hop = &mut self.hops[end.hop];
        if end.begins { &mut hop.from_offset } else { &mut hop.to_offset }
    }
}

const SWEEPS: usize = 16;
/// Hops of one channel up to which crossings are counted.
const MOST_COUNTED: usize = 600;
/// Distance of arrows at a side, px.
const WIDEST_STEP: f64 = 40.0;
