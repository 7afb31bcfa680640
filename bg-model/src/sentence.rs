//! Errors that show their sentence wherever they are shown.
//!
//! A program whose `main` gives back an error prints it by `Debug`, and so do `unwrap` and `expect`: what a user sees
//! there has to be what `Display` says. Programs read the fields.

/// Lets `Debug` of a type say what its `Display` says.
macro_rules! debug_is_display {
    ($name:ident $(<$(const $parameter:ident: $of:ty),+>)?) => {
        impl $(<$(const $parameter: $of),+>)? core::fmt::Debug for $name $(<$($parameter),+>)? {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Display::fmt(self, f)
            }
        }
    };
}
