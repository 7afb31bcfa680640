//! Runs the bench for two seconds and prints the states' bits: the same text on a controller and on a desktop.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), motor_observer::Fault> {
    let mut text = String::new();
    motor_observer::report::<f64>(&mut text, 2000, |step| step())?;
    motor_observer::report::<f32>(&mut text, 2000, |step| step())?;
    print!("{text}");
    Ok(())
}
