//! What a record of a TensorFlow data set holds: features by name (`tf.train.Example`).
//!
//! *Source*: `tensorflow/core/example/example.proto` and `feature.proto`, of which only the field numbers are taken.

use alloc::collections::BTreeMap;

use prost::Message;

/// A list of byte strings.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Strings {
    #[prost(bytes = "vec", repeated, tag = "1")]
    pub(crate) value: Vec<Vec<u8>>,
}

/// A list of numbers.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Floats {
    #[prost(float, repeated, tag = "1")]
    pub(crate) value: Vec<f32>,
}

/// A list of whole numbers.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Integers {
    #[prost(int64, repeated, tag = "1")]
    pub(crate) value: Vec<i64>,
}

/// What a feature holds.
#[derive(Clone, PartialEq, prost::Oneof)]
pub(crate) enum Values {
    #[prost(message, tag = "1")]
    Strings(Strings),
    #[prost(message, tag = "2")]
    Floats(Floats),
    #[prost(message, tag = "3")]
    Integers(Integers),
}

/// A feature.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Feature {
    #[prost(oneof = "Values", tags = "1, 2, 3")]
    pub(crate) values: Option<Values>,
}

/// Features by name.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Features {
    #[prost(btree_map = "string, message", tag = "1")]
    pub(crate) feature: BTreeMap<String, Feature>,
}

/// A record.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Example {
    #[prost(message, optional, tag = "1")]
    pub(crate) features: Option<Features>,
}

impl Example {
    /// The record that bytes hold.
    ///
    /// # Errors
    /// What is wrong with them, in words.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        Self::decode(bytes).map_err(|error| format!("holds no features: {error}"))
    }

    fn values(&self, name: &str) -> Option<&Values> {
        self.features.as_ref()?.feature.get(name)?.values.as_ref()
    }

    /// A feature of `count` bytes, in one string or in one string per byte.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub(crate) fn bytes(&self, name: &str, count: usize) -> Result<Vec<u8>, String> {
        let Some(Values::Strings(strings)) = self.values(name) else {
            return Err(format!("has no feature '{name}' of bytes"));
        };
        let bytes = strings.value.concat();
        if bytes.len() == count { Ok(bytes) } else { Err(wrong_count(name, bytes.len(), count)) }
    }

    /// A feature of `count` numbers.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub(crate) fn floats(&self, name: &str, count: usize) -> Result<&[f32], String> {
        let Some(Values::Floats(floats)) = self.values(name) else {
            return Err(format!("has no feature '{name}' of numbers"));
        };
        if floats.value.len() == count { Ok(&floats.value) } else { Err(wrong_count(name, floats.value.len(), count)) }
    }

    /// How many numbers a feature holds; 0 if there is none.
    pub(crate) fn float_count(&self, name: &str) -> usize {
        if let Some(Values::Floats(floats)) = self.values(name) { floats.value.len() } else { 0 }
    }
}

fn wrong_count(name: &str, found: usize, expected: usize) -> String {
    format!("has {found} values in '{name}', must have {expected}: is it the right --preset?")
}
