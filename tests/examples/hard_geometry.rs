//! Scores fits of hard geometry: twins of one color at shrinking gaps, and objects that leave the image.
//!
//! `cargo run --release -p dvp-tests --example hard_geometry -- twins|crop [PICTURES] [--bank]` prints one line per gap or
//! per hidden share: pictures with the right count, pictures whose objects are all found (one fitted object each with a
//! mask IoU of at least 0.9), ARI and IoU of the ownership, MAE, and thread-CPU milliseconds (median, slowest tenth).

use core::error::Error;
use std::io::Write as _;

use cpu_time::ThreadTime;
use dvp::format::mdshr_bank;
use dvp_core::Image;
use dvp_core::loss::ImagePair;
use dvp_core::metric::Tally;
use dvp_fit::{FitOptions, FitScratch, Fitter};
use dvp_lab::hard::{cropped, twins};
use dvp_tests::hard_geometry::{all_found, ownership, paint, rounded};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let count = arguments.iter().find_map(|word| word.parse().ok()).unwrap_or(40_u64);
    let bank = arguments.iter().any(|word| word == "--bank").then(mdshr_bank);
    let verbose = arguments.iter().any(|word| word == "--verbose");
    let fitter = Fitter::new(FitOptions::default().with_bank(bank))?;
    let crop = arguments.iter().any(|word| word == "crop");
    let levels: &[f32] = if crop { &[0.3, 0.5, 0.7, 0.9] } else { &[0.3, 0.2, 0.15, 0.1, 0.075, 0.05] };
    let mut out = std::io::stdout().lock();
    let mut scratch = FitScratch::default();
    for &level in levels {
        let (mut tally, mut exact, mut found, mut mae) = (Tally::default(), 0, 0, 0.0);
        let mut times = Vec::new();
        for index in 0..count {
            let truth = if crop { cropped(level, index)? } else { twins(level, index) };
            let image: Image<f32> = rounded(&paint(&truth));
            let clock = ThreadTime::now();
            let fit = fitter.fit(image.view(), &mut scratch)?;
            times.push(clock.elapsed().as_secs_f64() * 1e3);
            exact += usize::from(fit.scene.objects.len() == truth.objects.len());
            let all = all_found(&truth, &fit.scene, 0.9);
            found += usize::from(all);
            mae += f64::from(fit.loss);
            let painted = paint(&fit.scene);
            let pair = ImagePair::new(painted.view(), image.view())?;
            tally.add(pair, &ownership(&fit.scene), &ownership(&truth))?;
            if verbose && !all {
                let shapes: Vec<_> = truth.objects.iter().map(|object| object.prototype()).collect();
                writeln!(out, "  {index}: {shapes:?}, {} objects, mae {:.5}", fit.scene.objects.len(), fit.loss)?;
            }
        }
        times.sort_by(f64::total_cmp);
        let scores = tally.scores().ok_or("no picture")?;
        #[expect(clippy::cast_precision_loss, reason = "few pictures")]
        let share = |part: usize| part as f64 / count as f64;
        writeln!(
            out,
            "{level:5.3}  count {:.3}  found {:.3}  ARI {:.4}  IoU {:.4}  MAE {:.5}  ms {:.2} {:.2}",
            share(exact),
            share(found),
            scores.ari,
            scores.iou,
            mae / share(1).recip(),
            times[times.len() / 2],
            times[times.len() * 9 / 10],
        )?;
    }
    Ok(())
}
