//! Results that are made when they are first asked for.
//!
//! In: how a result is made, of its own data. Out: a [`Deferred`] result, which threads may share.

use std::sync::LazyLock;

/// A result that is made when it is first asked for, by whoever asks.
pub type Deferred<T> = LazyLock<T, Box<dyn FnOnce() -> T + Send>>;

/// The result that `make` gives.
pub fn deferred<T>(make: impl FnOnce() -> T + Send + 'static) -> Deferred<T> {
    LazyLock::new(Box::new(make))
}
