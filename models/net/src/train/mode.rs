//! What a model learns from.

use core::fmt;
use core::str::FromStr;

/// A regime of training: where images come from, and in which space predictions are judged.
///
/// *Source*: the paper, section on training; the letters are its own: T(arget images) or G(enerator), I(mages) or
/// P(arameters).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Images, judged by how they are painted again: L_x(x, r(g(f(x)))).
    Ti,
    /// Scenes, judged by what is read off their images: L_p(p, g(f(r(p)))).
    Gp,
    /// Scenes, judged by how they are painted again: L_x(r(p), r(g(f(r(p))))).
    Gi,
    /// Both at once, which is not in the paper: L_p finds the objects and keeps them one to one, L_x gives them their edges.
    GpGi,
    /// Images, judged by what is read off the repainted image: L_p(g(f(x)), g(f(r(g(f(x)))))).
    Tp,
    /// As [`Self::Ti`], from the weights of an early [`Self::Gp`].
    TiPlus,
    /// L_x as in [`Self::TiPlus`], and L_p of a scene made from the prediction: from the weights of an early
    /// [`Self::Gp`].
    TiTp,
}

/// Where the images of a mode come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// Pictures alone: T.
    Images,
    /// Scenes with their pictures: G.
    Scenes,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 7] = [Self::Ti, Self::Gp, Self::Gi, Self::GpGi, Self::Tp, Self::TiPlus, Self::TiTp];

    /// The name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ti => "ti",
            Self::Gp => "gp",
            Self::Gi => "gi",
            Self::GpGi => "gp-gi",
            Self::Tp => "tp",
            Self::TiPlus => "ti+",
            Self::TiTp => "ti-tp",
        }
    }

    /// What it needs.
    #[must_use]
    pub fn source(self) -> Source {
        match self {
            Self::Gp | Self::Gi | Self::GpGi => Source::Scenes,
            Self::Ti | Self::Tp | Self::TiPlus | Self::TiTp => Source::Images,
        }
    }

    /// Whether L_x is part of its loss.
    #[must_use]
    pub fn has_image_loss(self) -> bool {
        matches!(self, Self::Ti | Self::Gi | Self::GpGi | Self::TiPlus | Self::TiTp)
    }

    /// Whether L_p is part of its loss.
    #[must_use]
    pub fn has_parameter_loss(self) -> bool {
        matches!(self, Self::Gp | Self::GpGi | Self::Tp | Self::TiTp)
    }

    /// Whether it goes on from the weights of another run.
    #[must_use]
    pub fn continues(self) -> bool {
        matches!(self, Self::TiPlus | Self::TiTp)
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Mode {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|mode| mode.name().eq_ignore_ascii_case(text));
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("there is no mode '{text}'; the modes are {names}")
        })
    }
}
