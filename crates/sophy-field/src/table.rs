/// Rows of different length in one piece of memory (compressed rows).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table<T> {
    /// Where each row begins; one more than there are rows.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T> Default for Table<T> {
    fn default() -> Self {
        Table { starts: vec![0], items: Vec::new() }
    }
}

impl<T: Copy> Table<T> {
    /// A table of `rows` rows from pairs of row and item; items of a row keep their order.
    pub fn from_pairs(rows: usize, pairs: &[(u32, T)]) -> Self {
        let mut starts = vec![0u32; rows + 1];
        for &(row, _) in pairs {
            starts[row as usize + 1] += 1;
        }
        for row in 0..rows {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut items: Vec<T> = pairs.iter().map(|pair| pair.1).collect();
        for &(row, item) in pairs {
            let at = &mut next[row as usize];
            items[*at as usize] = item;
            *at += 1;
        }
        Table { starts, items }
    }

    /// Gives back what it took to grow.
    pub fn shrink_to_fit(&mut self) {
        self.starts.shrink_to_fit();
        self.items.shrink_to_fit();
    }

    /// Appends a row.
    pub fn push(&mut self, row: impl IntoIterator<Item = T>) {
        self.items.extend(row);
        self.starts.push(self.items.len() as u32);
    }
}

impl<T> Table<T> {
    /// The items of a row.
    #[inline]
    pub fn row(&self, row: usize) -> &[T] {
        &self.items[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_of_a_row_keep_their_order() {
        let table = Table::from_pairs(4, &[(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (2, 'e')]);
        let mut pushed = Table::default();
        for row in [&['b'][..], &[], &['a', 'c', 'e'], &['d']] {
            pushed.push(row.iter().copied());
        }
        assert_eq!(table, pushed);
        assert_eq!((table.row(1), table.row(2)), (&[][..], &['a', 'c', 'e'][..]));
    }
}
