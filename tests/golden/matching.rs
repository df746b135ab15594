//! The reference's matchings (scipy) of predicted objects to true ones.

use dvp_core::matching::{CostMatrix, Hungarian, MatchingCost};

use super::scene_pairs;

#[test]
fn matchings_of_the_reference() {
    let (mut solver, mut costs, mut checked) = (Hungarian::default(), vec![], 0);
    for pair in scene_pairs::all().iter().flat_map(|file| &file.pairs) {
        let (truth, prediction) = (pair.truth.scene(), pair.pred.scene());
        let visible: Vec<_> = truth.objects.iter().filter(|object| object.confidence > 0.5).collect();
        assert_eq!(visible.len(), pair.n_true);
        MatchingCost::reference().fill(visible, &prediction.objects, &mut costs);
        let matrix = CostMatrix::new(pair.n_true, prediction.objects.len(), &costs).unwrap();
        let theirs: Vec<_> = pair.match_pred_order[..pair.n_true].iter().map(|&slot| Some(slot)).collect();
        assert_eq!(pair.match_true, (0..pair.n_true).collect::<Vec<_>>());
        assert_eq!(solver.solve(matrix).unwrap().column_of, theirs);
        checked += 1;
    }
    assert!(checked >= 3);
}
