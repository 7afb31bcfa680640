//! Curves with no more points than the eye can tell apart at the drawn size.
//!
//! In: points of a curve. Out: fewer points that draw the same. A curve over time keeps, in every column of the
//! drawing, its first, lowest, highest and last point (the M4 aggregation of Jugel et al., VLDB 2014); a path keeps
//! points that are a visible distance apart.

/// The points of a curve over time, at most four for each of `columns` equal intervals of time. `points` ascend in
/// time.
pub fn over_time(points: &[(f64, f64)], columns: usize) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    if points.len() <= 4 * columns {
        return points.to_vec();
    }
    let width = (last.0 - first.0) / columns as f64;
    let column = |point: &(f64, f64)| (((point.0 - first.0) / width) as usize).min(columns - 1);
    points.chunk_by(|a, b| column(a) == column(b)).flat_map(extremes).collect()
}

/// The first, lowest, highest and last point of a chunk, each once, in their order.
fn extremes(chunk: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let by_value = |a: &&usize, b: &&usize| canonical(chunk[**a].1).total_cmp(&canonical(chunk[**b].1));
    let all: Vec<usize> = (0..chunk.len()).collect();
    let mut kept: Vec<usize> = [all.first(), all.iter().min_by(by_value), all.iter().max_by(by_value), all.last()]
        .into_iter()
        .flatten()
        .copied()
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| chunk[index]).collect()
}

/// The number, and of what is no number always the same bits: those of 0/0 are another sign from machine to machine,
/// and in a browser from one call to the next.
pub(crate) fn canonical(value: f64) -> f64 {
    const NONE: f64 = f64::from_bits(0x7ff8_0000_0000_0000);
    if value.is_nan() { NONE } else { value }
}

/// The points of a path that are at least `distance` apart along it, and its last one; every n-th of them where they
/// are more than `most`.
pub fn along_path(points: &[(f64, f64)], distance: f64, most: usize) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for &point in points {
        let near = kept.last().is_some_and(|last| (point.0 - last.0).hypot(point.1 - last.1) < distance);
        if !near {
            kept.push(point);
        }
    }
    let stride = kept.len().div_ceil(most).max(1);
    let mut kept: Vec<_> = kept.into_iter().step_by(stride).collect();
    if let Some(&last) = points.last()
        && kept.last() != Some(&last)
    {
        kept.push(last);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_of_what_is_no_number_changes_nothing() {
        let thin = |none: f64| {
            let value = |k: i32| if k % 7 == 0 { none } else { f64::from(k % 11) };
            let points: Vec<_> = (0..4000).map(|k| (f64::from(k), value(k))).collect();
            over_time(&points, 50)
                .into_iter()
                .map(|(t, value)| (t.to_bits(), canonical(value).to_bits()))
                .collect::<Vec<_>>()
        };
        assert_eq!(thin(f64::NAN), thin(-f64::NAN));
    }

    #[test]
    fn a_spike_survives() {
        let points: Vec<_> = (0..10_000).map(|k| (f64::from(k), if k == 4321 { 1.0 } else { 0.0 })).collect();
        let thin = over_time(&points, 100);
        assert!(thin.len() <= 400);
        assert!(thin.contains(&(4321.0, 1.0)));
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
        assert!(thin.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_short_curve_stays_as_it_is() {
        let points = [(0.0, 1.0), (1.0, 2.0)];
        assert_eq!(over_time(&points, 100), points);
        assert_eq!(over_time(&[], 100), []);
    }

    #[test]
    fn a_path_at_rest_is_one_point() {
        assert_eq!(along_path(&[(1.0, 1.0); 50], 0.1, 10), [(1.0, 1.0)]);
        let line: Vec<_> = (0..1000).map(|k| (f64::from(k), 0.0)).collect();
        assert!(along_path(&line, 0.5, 100).len() <= 101);
    }
}
