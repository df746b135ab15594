//! What came of a run: whether it succeeded, how it failed, and whether it said so itself.

use anyhow::Result;
use dvp_core::loss::{ImagePair, Loss};
use dvp_core::metric::{Ownership, OwnershipRule, RandIndexScratch, adjusted_rand_index};
use dvp_core::render::{ContourRenderer, PixelLoss};
use dvp_core::{ImageSize, Scene, Shape as _};
use dvp_fit::{Doubts, Fit, StopReason};

use super::calibration::Stated;
use super::sweep::Case;
use crate::agreement::Agreement;
use dvp_cli::method::{Found, Method, Start};
use dvp_cli::paint::Painter;

/// An object is found if it agrees with the true one to this IoU: its size is then right within 5 %, or its place within
/// 8 % of its radius.
pub(super) const FOUND: f64 = 0.9;

/// Objects moved by less (scene units) have not moved.
const MOVED: f32 = 1e-6;

/// How a run failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// It panicked.
    Panicked,
    /// It did not end in time.
    Endless,
    /// A number of the scene or its covariance is NaN or infinite.
    NotFinite,
    /// An error instead of a result.
    Refused,
    /// Too many or too few objects.
    WrongCount,
    /// An object is not where it should be, and is where it started.
    NoGradient,
    /// An object is not what it should be.
    WrongPose,
}

impl Failure {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Panicked => "panic",
            Self::Endless => "endless",
            Self::NotFinite => "not finite",
            Self::Refused => "refused",
            Self::WrongCount => "wrong count",
            Self::NoGradient => "no gradient",
            Self::WrongPose => "wrong pose",
        }
    }
}

/// What came of a run.
#[derive(Clone, Debug)]
pub(super) struct Verdict {
    /// None: it succeeded.
    pub(super) failure: Option<Failure>,
    pub(super) doubts: Doubts,
    pub(super) count_is_right: bool,
    /// Worst IoU of an object.
    pub(super) iou: f64,
    /// Mean absolute error against what was drawn, before it was spoiled; NaN without a result.
    pub(super) mae: f64,
    /// Adjusted Rand index; NaN without a result.
    pub(super) ari: f64,
    /// Processor time; NaN without a result.
    pub(super) cpu_ms: f64,
    pub(super) unexplained: f64,
    pub(super) stop: Option<StopReason>,
    /// How the true poses lie in the stated uncertainties.
    pub(super) stated: Stated,
}

impl Verdict {
    /// A run without a result.
    pub(super) fn none(failure: Failure) -> Self {
        Self {
            failure: Some(failure),
            doubts: Doubts::default(),
            count_is_right: false,
            iou: 0.0,
            mae: f64::NAN,
            ari: f64::NAN,
            cpu_ms: f64::NAN,
            unexplained: f64::NAN,
            stop: None,
            stated: Stated::default(),
        }
    }

    /// Whether the result doubts itself; a refusal does.
    pub(super) fn is_doubted(&self) -> bool {
        self.doubts.any() || self.failure == Some(Failure::Refused)
    }

    /// Failed without a word.
    pub(super) fn is_silent(&self) -> bool {
        self.failure.is_some() && !self.is_doubted()
    }

    /// Judges a result.
    pub(super) fn of(case: &Case, found: &Found, method: Method) -> Result<Self> {
        let size = case.image.size();
        let cpu_ms = found.cpu.as_secs_f64() * 1e3;
        if !is_finite(&found.fit) {
            return Ok(Self { cpu_ms, ..Self::none(Failure::NotFinite) });
        }
        let agreement = Agreement::of(&case.truth, &found.there, size)?;
        let started = case.start.as_ref().filter(|_| method.start() == Start::Scene);
        let stuck = started.is_some_and(|start| is_stuck(start, &found.there, &agreement));
        let failure = if agreement.holds(FOUND) {
            None
        } else if agreement.found != agreement.expected() {
            Some(Failure::WrongCount)
        } else if stuck {
            Some(Failure::NoGradient)
        } else {
            Some(Failure::WrongPose)
        };
        let (mae, ari) = errors(&case.truth, found, size)?;
        Ok(Self {
            failure,
            doubts: found.fit.doubts(),
            count_is_right: agreement.found == agreement.expected(),
            iou: agreement.worst(),
            mae,
            ari,
            cpu_ms,
            unexplained: found.fit.unexplained,
            stop: Some(found.fit.stop),
            stated: Stated::of(&case.truth, found, &agreement, size)?,
        })
    }
}

/// Whether an object that is not found is where it started.
fn is_stuck(start: &Scene<f32>, found: &Scene<f32>, agreement: &Agreement) -> bool {
    start.objects.iter().zip(&found.objects).enumerate().any(|(k, (start, found))| {
        let missed = agreement.matches.get(k).is_none_or(|pair| pair.is_none_or(|pair| pair.iou < FOUND));
        let off = (0..2).map(|c| (start.pose.translation[c] - found.pose.translation[c]).abs());
        let turned = (start.pose.rotation - found.pose.rotation).abs();
        let grown = (start.pose.scale - found.pose.scale).abs();
        missed && off.fold(turned.max(grown), f32::max) < MOVED
    })
}

/// Mean absolute error against the true scene's picture, and adjusted Rand index of what is seen.
fn errors(truth: &Scene<f32>, found: &Found, size: ImageSize) -> Result<(f64, f64)> {
    let painter = Painter::default();
    let [drawn, painted] = [truth, &found.fit.scene].map(|scene| painter.paint(scene, size));
    let (drawn, painted) = (drawn?, painted?);
    let pair = ImagePair::new(painted.view(), drawn.view())?;
    let owned = |scene: &Scene<f32>| -> Result<Ownership> {
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        let mut owned = Ownership::default();
        let rule = OwnershipRule::Seen(scene.compositing);
        owned.fill_drawing(rule, &renderer, &painter.draw(scene, size)?, size, &mut Default::default())?;
        Ok(owned)
    };
    let (truly, owned) = (owned(truth)?, owned(&found.there)?);
    let ari = adjusted_rand_index(owned.index(), truly.index(), &mut RandIndexScratch::default())?;
    Ok((f64::from(PixelLoss::Mae.value(pair, &mut ())?), ari))
}

/// Whether all numbers of a scene and its covariances are finite.
fn is_finite(fit: &Fit<f32>) -> bool {
    let objects = fit.scene.objects.iter().flat_map(|object| {
        let pose = &object.pose;
        let pose = [pose.translation[0], pose.translation[1], pose.scale, pose.rotation, object.confidence];
        let mut numbers = Vec::new();
        object.shape.numbers(&mut numbers);
        pose.into_iter().chain(object.color()).chain(numbers)
    });
    let covariance = fit.covariance.iter().flatten().copied();
    objects.chain(fit.scene.background).chain(covariance).all(f32::is_finite)
}
