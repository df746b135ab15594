//! The backends that the models are compared on.

/// Runs a generic `fn<B: Backend>(&B::Device)` on every backend. A backend is one line: its type and a device.
macro_rules! on_every_backend {
    ($check:ident) => {
        $check::<dvp_core::tensor::Host>(&dvp_core::tensor::HostDevice);
    };
}

pub(crate) use on_every_backend;
