//! Linear equations over two elements: sums of unknowns that are even or odd.
//!
//! In: equations, the more important first. Out: values of the unknowns that satisfy all that do not contradict earlier
//! ones. Method: Gaussian elimination, a word for 64 unknowns.

/// A system of equations.
#[derive(Debug)]
pub(super) struct Parity {
    unknowns: usize,
    /// Equations, each with its first unknown, which occurs in no later row.
    rows: Vec<(usize, Row)>,
}

/// A sum of unknowns, and whether it is odd: the bit after those of the unknowns.
type Row = Vec<u64>;

impl Parity {
    pub fn new(unknowns: usize) -> Self {
        Self { unknowns, rows: Vec::new() }
    }

    /// Asks for the sum of these unknowns to be odd or even. What contradicts earlier equations is left out.
    pub fn ask(&mut self, sum: &[usize], is_odd: bool) {
        let mut row: Row = vec![0; self.unknowns / 64 + 1];
        sum.iter().for_each(|&unknown| row[unknown / 64] ^= 1 << (unknown % 64));
        row[self.unknowns / 64] ^= u64::from(is_odd) << (self.unknowns % 64);
        for (first, other) in &self.rows {
            if has(&row, *first) {
                row.iter_mut().zip(other).for_each(|(word, other)| *word ^= other);
            }
        }
        let first = row.iter().position(|&word| word != 0).map(|at| 64 * at + row[at].trailing_zeros() as usize);
        if let Some(first) = first.filter(|&first| first < self.unknowns) {
            self.rows.push((first, row));
        }
    }

    /// Values of the unknowns; those that are left free are zero.
    pub fn solve(&self) -> Vec<bool> {
        let mut values = vec![false; self.unknowns];
        for (first, row) in self.rows.iter().rev() {
            let others = (0..self.unknowns).filter(|&unknown| unknown != *first && has(row, unknown));
            let sum = others.fold(has(row, self.unknowns), |sum, unknown| sum ^ values[unknown]);
            values[*first] = sum;
        }
        values
    }
}

fn has(row: &Row, unknown: usize) -> bool {
    row[unknown / 64] >> (unknown % 64) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contradiction_is_left_out() {
        let mut parity = Parity::new(70);
        parity.ask(&[0, 69], true);
        parity.ask(&[0, 3], false);
        parity.ask(&[3, 69], false);
        parity.ask(&[3, 3, 0], true);
        let values = parity.solve();
        assert_eq!([values[0], values[3], values[69]], [true, true, false]);
    }
}
