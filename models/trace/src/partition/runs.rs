//! Runs of equal values side by side: what is of one color is read run by run instead of pixel by pixel.

use core::ops::Range;

/// Values that are compared at once.
const MANY: usize = 16;

/// The runs of a row from left to right: their value, and their columns.
pub(super) fn runs<V: Copy + PartialEq>(row: &[V]) -> impl Iterator<Item = (V, Range<usize>)> {
    let mut start = 0;
    core::iter::from_fn(move || {
        let rest = row.get(start..)?;
        let &value = rest.first()?;
        // Most runs are long: many values are compared at once as long as all of them go on.
        let goes_on = |values: &&[V; MANY]| values.iter().fold(true, |all, other| all & (*other == value));
        let whole = MANY * rest.as_chunks().0.iter().take_while(goes_on).count();
        let more = rest[whole..].iter().take_while(|other| **other == value).count();
        let columns = start..start + whole + more;
        start = columns.end;
        Some((value, columns))
    })
}

/// Where two rows differ, from left to right.
pub(super) fn differing<'a, V: Copy + PartialEq>(row: &'a [V], other: &'a [V]) -> impl Iterator<Item = usize> + 'a {
    let pieces = row.chunks(MANY).zip(other.chunks(MANY)).enumerate().filter(|(_, (a, b))| a != b);
    pieces
        .flat_map(|(piece, (a, b))| (0..a.len().min(b.len())).filter(|&i| a[i] != b[i]).map(move |i| piece * MANY + i))
}

/// Gives the runs of a row, which are numbered, other numbers.
pub(super) fn renumber(row: &mut [u32], mut number: impl FnMut(u32, Range<usize>) -> u32) {
    let mut start = 0;
    while let Some((run, columns)) = row.get(start..).and_then(|rest| runs(rest).next()) {
        let columns = start..start + columns.end;
        start = columns.end;
        row[columns.clone()].fill(number(run, columns));
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec;
    use alloc::vec::Vec;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn runs_say_what_a_row_holds(row in prop::collection::vec(0_u8..3, 0..40)) {
            let runs: Vec<_> = runs(&row).collect();
            let back: Vec<u8> = runs.iter().flat_map(|(value, columns)| vec![*value; columns.len()]).collect();
            prop_assert_eq!(back, row);
            prop_assert!(runs.windows(2).all(|two| two[0].0 != two[1].0 && two[0].1.end == two[1].1.start));
            prop_assert!(runs.iter().all(|(_, columns)| !columns.is_empty()));
        }

        #[test]
        fn rows_differ_where_they_do(rows in prop::collection::vec((0_u8..3, 0_u8..3), 0..40)) {
            let (row, other): (Vec<u8>, Vec<u8>) = rows.into_iter().unzip();
            let found: Vec<usize> = differing(&row, &other).collect();
            prop_assert_eq!(found, (0..row.len()).filter(|&i| row[i] != other[i]).collect::<Vec<_>>());
        }

        #[test]
        fn runs_are_renumbered_whole(row in prop::collection::vec(0_u32..3, 0..40)) {
            let mut seen = Vec::new();
            let mut renumbered = row.clone();
            renumber(&mut renumbered, |run, columns| {
                seen.push((run, columns));
                run + 1
            });
            prop_assert_eq!(seen, runs(&row).collect::<Vec<_>>());
            prop_assert!(row.iter().zip(&renumbered).all(|(old, new)| old + 1 == *new));
        }
    }
}
