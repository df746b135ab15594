//! Parameters under a path.

use core::cell::RefCell;

use dvp_core::dims::Dims;
use dvp_core::real::DType;
use dvp_core::tensor::{Backend, Parameters, ParametersError, Tensor, TensorError};

use crate::error::NetError;

/// The parameters whose names begin with a path: the weights of a model, or of a part of one.
///
/// # Examples
/// ```
/// use dvp_core::tensor::{Host, HostDevice, Parameters, Tensor};
/// use dvp_net::weights::Weights;
/// let mut parameters = Parameters::<Host>::new();
/// parameters.insert("model.norm.bias", &Tensor::new(vec![0.0_f32; 3], &[3], &HostDevice)?)?;
/// let norm = Weights::new(&parameters).under("model").under("norm");
/// assert!(norm.get("bias", &[3]).is_ok());
/// let error = norm.get("weight", &[3]).unwrap_err();
/// assert!(error.to_string().starts_with("there is no parameter model.norm.weight"));
/// # Ok::<(), dvp_core::tensor::TensorError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Weights<'a, B: Backend> {
    source: Source<'a, B>,
    path: String,
    frozen: bool,
}

/// Where weights come from.
#[derive(Clone, Copy, Debug)]
enum Source<'a, B: Backend> {
    Stored(&'a Parameters<B>),
    /// Nowhere: what is asked for is written down, and zeros are handed out.
    Asked {
        device: &'a B::Device,
        names: &'a RefCell<Vec<Asked>>,
    },
}

/// A weight that a model takes: its name and its extents.
pub type Asked = (String, Dims);

/// The weights that `load` takes, in the order in which it takes them: names and extents.
///
/// # Errors
/// As `load` does.
pub fn asked<B: Backend, M>(
    device: &B::Device,
    load: impl FnOnce(&Weights<'_, B>) -> Result<M, NetError>,
) -> Result<Vec<Asked>, NetError> {
    let names = RefCell::new(Vec::new());
    load(&Weights { source: Source::Asked { device, names: &names }, path: String::new(), frozen: false })?;
    Ok(names.into_inner())
}

impl<'a, B: Backend> Weights<'a, B> {
    /// All of them.
    #[must_use]
    pub fn new(parameters: &'a Parameters<B>) -> Self {
        Self { source: Source::Stored(parameters), path: String::new(), frozen: false }
    }

    /// Those under `path`, which is added to the path so far with a dot.
    #[must_use]
    pub fn under(&self, path: &str) -> Self {
        Self { path: self.name(path), ..self.clone() }
    }

    /// The same as constants: no gradient is kept for them, nor the steps of what is computed with them alone.
    #[must_use]
    pub fn frozen(self) -> Self {
        Self { frozen: true, ..self }
    }

    /// Whether there is one of that name under the path.
    #[must_use]
    pub fn contains(&self, name: &str) -> bool {
        matches!(self.source, Source::Stored(parameters) if parameters.get(&self.name(name)).is_ok())
    }

    /// The one of that name under the path.
    ///
    /// # Errors
    /// [`ParametersError::Missing`], with the whole name; [`ParametersError::Dims`] if its extents are not `extents`.
    pub fn get(&self, name: &str, extents: &[usize]) -> Result<Tensor<B>, NetError> {
        let name = self.name(name);
        let expected = Dims::new(extents).map_err(TensorError::from)?;
        let parameters = match self.source {
            Source::Stored(parameters) => parameters,
            Source::Asked { device, names } => {
                names.borrow_mut().push((name, expected));
                return Ok(Tensor::full(0.0, extents, DType::F32, device)?);
            }
        };
        let found = parameters.get(&name)?;
        if *found.dims() != expected {
            return Err(ParametersError::Dims { name, extents: Box::new([expected, *found.dims()]) }.into());
        }
        Ok(if self.frozen { found.detach()? } else { found.clone() })
    }

    fn name(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }
}
