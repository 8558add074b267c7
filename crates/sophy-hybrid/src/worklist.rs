use sophy_field::AutomatonIndex;

/// Automata that wait for something, each once, looked at in their order: the work is that of those that
/// wait, not of all.
#[derive(Clone, Debug)]
pub(crate) struct Worklist {
    members: Vec<AutomatonIndex>,
    is_member: Vec<bool>,
    /// Whether the members are in order.
    sorted: bool,
}

impl Worklist {
    pub(crate) fn empty(automata: usize) -> Self {
        Worklist { members: Vec::new(), is_member: vec![false; automata], sorted: true }
    }

    pub(crate) fn full(automata: usize) -> Self {
        Worklist {
            members: (0..automata).map(AutomatonIndex::new).collect(),
            is_member: vec![true; automata],
            sorted: true,
        }
    }

    pub(crate) fn insert(&mut self, automaton: AutomatonIndex) {
        let is_member = &mut self.is_member[automaton.position()];
        if !*is_member {
            *is_member = true;
            self.sorted &= self.members.last().is_none_or(|&last| last < automaton);
            self.members.push(automaton);
        }
    }

    /// Looks at the members in order; those for which `stays` is false leave.
    pub(crate) fn retain(&mut self, mut stays: impl FnMut(AutomatonIndex) -> bool) {
        if !self.sorted {
            self.members.sort_unstable();
            self.sorted = true;
        }
        let is_member = &mut self.is_member;
        self.members.retain(|&automaton| {
            let stays = stays(automaton);
            is_member[automaton.position()] = stays;
            stays
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_looked_at_in_order_and_once() {
        let mut list = Worklist::empty(5);
        for automaton in [3, 1, 3, 4, 1] {
            list.insert(AutomatonIndex(automaton));
        }
        let mut seen = Vec::new();
        list.retain(|automaton| {
            seen.push(automaton.0);
            automaton.0 != 3
        });
        assert_eq!(seen, [1, 3, 4]);
        list.insert(AutomatonIndex(3));
        list.insert(AutomatonIndex(0));
        seen.clear();
        list.retain(|automaton| {
            seen.push(automaton.0);
            false
        });
        assert_eq!(seen, [0, 1, 3, 4]);
        list.retain(|_| unreachable!("all have left"));
    }
}
