//! What a fit knows of the numbers that it found: how far they may be off, what is a guess, what is left unexplained.

use alloc::collections::BTreeMap;
use core::fmt;

use dvp_core::{Object, Real};
use dvp_fit::{Ambiguity, Completion, Doubts, Fit, StopReason};
use serde::{Deserialize, Serialize};

use super::strict::{maps_only, present};
use super::write::shortest;

/// The doubt of the scene of a picture that is transparent everywhere.
pub const INVISIBLE: &str = "invisible";

/// Doubts that files of earlier programs may name.
const FORMER: [&str; 2] = ["ambiguity", "faint"];

/// The names that a scene's doubts may have.
pub(super) fn doubt_names() -> impl Iterator<Item = &'static str> {
    Doubts::default().named().into_iter().map(|(name, _)| name).chain([INVISIBLE]).chain(FORMER)
}

/// What a fit knows of a scene as a whole. What the method does not tell is missing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct SceneKnownJson {
    /// Why the fit stopped.
    pub stop: StopJson,
    /// Share of the picture's variance that neither the scene nor noise explains, [0, 1].
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub unexplained: Option<f64>,
    /// Standard deviation of a channel that was taken for noise; channels go from 0 to 1.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Description length of the scene and what it leaves unexplained, bits.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub bits: Option<f64>,
    /// What the fit says against itself: names of [`Doubts`], or [`INVISIBLE`].
    #[serde(default)]
    pub doubts: Vec<String>,
}

/// Why a fit stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum StopJson {
    /// The step or the gain fell below the tolerance.
    Converged,
    /// The number of steps was used up.
    StepLimit,
    /// No damping made the loss fall.
    Stalled,
    /// Nothing to fit: the image is one flat color.
    Empty,
    /// The picture is not flat.
    NotFlat,
    /// No scene was found that is nearer to the picture than one flat color, which is the scene.
    NoBetterThanFlat,
    /// For a reason that this version of the format has no name for.
    Other,
}

impl SceneKnownJson {
    /// That a fit stopped so; nothing else is known.
    #[must_use]
    pub fn new(stop: StopJson) -> Self {
        Self { stop, unexplained: None, noise: None, bits: None, doubts: Vec::new() }
    }
}

/// What a fit knows of an object.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct ObjectKnownJson {
    /// How far the numbers may be off.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub deviations: Option<DeviationsJson>,
    /// Share of the picture's variance that would be unexplained in addition if the object alone were left out.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub marginal_gain: Option<f64>,
    /// Intersection over union to expect of what is seen of the object and what is there, [0, 1].
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub expected_iou: Option<f64>,
    /// What remains open.
    #[serde(default)]
    pub doubts: Vec<DoubtJson>,
}

/// Standard deviations, each in the unit of its number. What is not known is missing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct DeviationsJson {
    /// Of the translation, x and y.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub translation: Option<[f64; 2]>,
    /// Of the scale.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Of the rotation, radians.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub rotation: Option<f64>,
    /// Of the color, channel by channel.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub color: Option<[f64; 3]>,
    /// Of the numbers of the shape: `radius`, `size[0]`, `rings[0].points[3][1]`, ...
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub numbers: BTreeMap<String, f64>,
}

/// What a fit cannot tell of an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum DoubtJson {
    /// The angle is known modulo 2 pi / order.
    Symmetry {
        /// Symmetry order; 0 for a disk.
        order: usize,
    },
    /// The object leaves the image.
    Cropped {
        /// Visible share of the outline, [0, 1].
        visible: f64,
    },
    /// A part of the outline lies behind objects that are painted later: it is a guess.
    Hidden {
        /// Share of the length of the outline that is hidden, [0, 1].
        share: f64,
        /// Where the guess comes from.
        completion: CompletionJson,
    },
    /// The object has run together with another one of its color.
    Merged {
        /// Index of the other object, the first of them if there are several.
        other: usize,
        /// Share of the outline that lies in none of the others, [0, 1].
        visible: f64,
    },
    /// Another prototype explains the object nearly as well.
    Twin {
        /// Index of the other prototype.
        prototype: usize,
        /// Its squared error over that of the one chosen; at least 1.
        ratio: f64,
    },
}

/// What completes the hidden part of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum CompletionJson {
    /// The prototype that fits what is seen.
    Prototype {},
    /// What is seen repeats itself when it is turned.
    Rotation {
        /// Symmetry order; 0 for a disk.
        order: usize,
    },
    /// What is seen is its own mirror image.
    Mirror {},
    /// The shortest way across.
    Straight {},
    /// Something that this version of the format has no name for.
    Other {},
}

maps_only!(SceneKnownJson, ObjectKnownJson, DeviationsJson, DoubtJson, CompletionJson);

impl SceneKnownJson {
    /// What a fit knows of its scene; `visible`: whether any pixel of the picture shows something.
    #[must_use]
    pub fn of<T: Real>(fit: &Fit<T>, visible: bool) -> Self {
        let doubts = fit.doubts().named().into_iter().filter(|&(_, is)| is).map(|(name, _)| name);
        Self {
            stop: StopJson::of(fit.stop),
            unexplained: finite(fit.unexplained),
            noise: finite(shortest(fit.noise)),
            bits: finite(fit.bits),
            doubts: doubts.chain((!visible).then_some(INVISIBLE)).map(str::to_owned).collect(),
        }
    }
}

impl StopJson {
    fn of(stop: StopReason) -> Self {
        match stop {
            StopReason::Converged => Self::Converged,
            StopReason::StepLimit => Self::StepLimit,
            StopReason::Stalled => Self::Stalled,
            StopReason::Empty => Self::Empty,
            StopReason::NotFlat => Self::NotFlat,
            StopReason::NoBetterThanFlat => Self::NoBetterThanFlat,
            _ => Self::Other,
        }
    }
}

impl fmt::Display for StopJson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Converged => "converged",
            Self::StepLimit => "step limit",
            Self::Stalled => "stalled",
            Self::Empty => "empty",
            Self::NotFlat => "not flat",
            Self::NoBetterThanFlat => "no better than flat",
            Self::Other => "other",
        })
    }
}

impl ObjectKnownJson {
    /// What a fit knows of each of its objects.
    #[must_use]
    pub fn of<T: Real>(fit: &Fit<T>) -> Vec<Self> {
        let objects = fit.scene.objects.iter().enumerate();
        let mut known: Vec<Self> = objects
            .map(|(k, object)| Self {
                deviations: fit.covariance.get(k).map(|covariance| DeviationsJson::of_pose(object, covariance)),
                marginal_gain: fit.marginal_gain.get(k).copied().and_then(finite),
                expected_iou: fit.expected_iou.get(k).and_then(|&iou| finite(shortest(iou))),
                doubts: Vec::new(),
            })
            .collect();
        for (object, doubt) in fit.ambiguity.iter().filter_map(DoubtJson::of) {
            if let Some(known) = known.get_mut(object) {
                known.doubts.push(doubt);
            }
        }
        known
    }

    /// Whether there is nothing to say.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl DeviationsJson {
    /// Those of a pose; `covariance`, row by row, is that of (x, y, log scale, rotation, log stretch).
    fn of_pose<T: Real>(object: &Object<T>, covariance: &[T; 25]) -> Self {
        let [x, y, log_scale, rotation] = [0, 6, 12, 18].map(|k| covariance[k].sqrt());
        let known = |deviation: T| finite(shortest(deviation));
        Self {
            translation: known(x).zip(known(y)).map(<[f64; 2]>::from),
            scale: known(object.pose.scale * log_scale),
            rotation: known(rotation),
            ..Self::default()
        }
    }
}

impl DoubtJson {
    /// An ambiguity, and the index of its object. Shares are clamped to [0, 1], which sums overshoot by rounding.
    fn of(ambiguity: &Ambiguity) -> Option<(usize, Self)> {
        Some(match *ambiguity {
            Ambiguity::Symmetry { object, order } => (object, Self::Symmetry { order }),
            Ambiguity::Cropped { object, visible } => (object, Self::Cropped { visible: visible.clamp(0.0, 1.0) }),
            Ambiguity::Hidden { object, share, completion } => {
                (object, Self::Hidden { share: share.clamp(0.0, 1.0), completion: CompletionJson::of(completion) })
            }
            Ambiguity::Merged { object, other, visible } => {
                (object, Self::Merged { other, visible: visible.clamp(0.0, 1.0) })
            }
            Ambiguity::Twin { object, prototype, ratio } => (object, Self::Twin { prototype, ratio }),
            _ => return None,
        })
    }
}

impl CompletionJson {
    fn of(completion: Completion) -> Self {
        match completion {
            Completion::Prototype => Self::Prototype {},
            Completion::Rotation { order } => Self::Rotation { order },
            Completion::Straight => Self::Straight {},
            _ => Self::Other {},
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
