//! What a drawing has and a scene has not.

use alloc::collections::BTreeMap;
use core::fmt;

/// What was not kept, by its name in SVG, and what became of it; each with how often it came.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Losses(BTreeMap<&'static str, usize>);

impl Losses {
    pub(super) fn add(&mut self, loss: &'static str) {
        *self.0.entry(loss).or_insert(0) += 1;
    }

    /// Whether everything was kept.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Name and fate of what was not kept, and how often it came.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, usize)> + '_ {
        self.0.iter().map(|(&loss, &count)| (loss, count))
    }
}

impl fmt::Display for Losses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, (loss, count)) in self.iter().enumerate() {
            let start = if k == 0 { "" } else { "; " };
            match count {
                1 => write!(f, "{start}{loss}")?,
                _ => write!(f, "{start}{loss} ({count} times)")?,
            }
        }
        Ok(())
    }
}
