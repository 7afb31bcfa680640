//! Random numbers for tests.

/// Marsaglia's xorshift generator (Journal of Statistical Software 8, 2003), in 0..1.
pub fn random_numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}
