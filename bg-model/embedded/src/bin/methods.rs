//! Runs the observer's model by every method of `integrate` and prints the bits where each comes to: the same text on a
//! controller and on a desktop.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    motor_observer::board::program(32 * 1024, |host| motor_observer::methods(host))
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), motor_observer::Fault> {
    let mut text = String::new();
    motor_observer::methods(&mut text)?;
    print!("{text}");
    Ok(())
}
