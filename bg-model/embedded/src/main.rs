//! Runs the bench for two seconds and prints the states' bits: the same text on a controller and on a desktop. On a
//! controller then what a sample takes at most.

#![cfg_attr(target_os = "none", no_std, no_main)]

/// Samples of a run.
const SAMPLES: u32 = 2000;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use core::fmt::Write;
    use motor_observer::board::{Clock, program};

    program(1024, |host| {
        let (mut double, mut single) = (Clock::start(), Clock::start());
        motor_observer::report::<f64>(host, SAMPLES, |step| double.time(step))?;
        motor_observer::report::<f32>(host, SAMPLES, |step| single.time(step))?;
        let [double, single] = [double, single].map(|clock| clock.longest());
        Ok(writeln!(host, "# longest sample {double} instructions in f64, {single} in f32")?)
    })
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), motor_observer::Fault> {
    let mut text = String::new();
    motor_observer::report::<f64>(&mut text, SAMPLES, |step| step())?;
    motor_observer::report::<f32>(&mut text, SAMPLES, |step| step())?;
    print!("{text}");
    Ok(())
}
