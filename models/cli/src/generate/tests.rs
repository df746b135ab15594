use dvp_core::ImageSize;

use super::sample::closest_distance;
use super::{Range, SceneSettings, sample_scene};
use crate::format::mdshr_bank;

#[test]
fn ranges_are_read() {
    assert_eq!("0.1..0.3".parse(), Ok(Range::new(0.1, 0.3)));
    assert_eq!("2".parse(), Ok(Range::new(2.0, 2.0)));
    for text in ["", "0.3..0.1", "a..b", "0..NaN", "1..inf"] {
        assert!(text.parse::<Range>().unwrap_err().contains("0.1..0.3"), "{text}");
    }
}

#[test]
fn scenes_follow_the_settings_and_their_number_only() {
    let bank = mdshr_bank();
    let size = ImageSize::new(128, 128).unwrap();
    let settings = SceneSettings::mds_hr();
    let mut counts = [0; 5];
    let mut shapes = [0; 3];
    let mut closest = 0.0;
    for index in 0..400 {
        let scene = sample_scene(&settings, &bank, size, 7, index);
        assert_eq!(scene, sample_scene(&settings, &bank, size, 7, index));
        assert_ne!(scene, sample_scene(&settings, &bank, size, 8, index));
        counts[scene.objects.len()] += 1;
        for object in &scene.objects {
            shapes[object.prototype().unwrap()] += 1;
            assert!((0.1..=0.3).contains(&object.pose.scale));
            assert!(object.pose.translation.iter().all(|v| (0.05..=0.95).contains(v)));
        }
        let slots = SceneSettings { keep_hidden: true, ..settings };
        let all = sample_scene(&slots, &bank, size, 7, index).objects;
        assert_eq!(all.len(), 4);
        let points: Vec<[f32; 2]> = all.iter().map(|o| o.pose.translation).collect();
        closest += closest_distance(&points) / 400.0;
    }
    // Expected 100 each; 3 standard deviations are 26.
    assert!(counts[0] == 0 && counts[1..].iter().all(|n| (74..=126).contains(n)), "{counts:?}");
    // Expected about 333 of 1000 each; 3 standard deviations are 45.
    assert!(shapes.iter().all(|n| (280..=390).contains(n)), "{shapes:?}");
    // One draw of four points has a smallest distance of about 0.18, the best of eight about 0.37.
    assert!(closest > 0.3, "{closest}");
}

#[test]
fn bad_settings_name_the_option() {
    let good = SceneSettings::mds_hr();
    assert_eq!(good.check(), Ok(()));
    assert_eq!(SceneSettings::multi_dsprites().check(), Ok(()));
    assert!(SceneSettings { slots: 2, ..good }.check().unwrap_err().contains("--slots"));
    assert!(SceneSettings { margin: 0.5, ..good }.check().unwrap_err().contains("--margin"));
    assert!(SceneSettings { scale: Range::new(0.0, 0.1), ..good }.check().unwrap_err().contains("--scale"));
}
