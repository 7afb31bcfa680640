//! The model by every method that there is: adaptive and implicit ones too, whose cost depends on the motion.

use core::fmt::Write;

use bg_model::input::Input;
use bg_model::integrator::{
    Ark5, Auto, Bs5, Cfmr7, Dop853, Gauss6, Method, Nystrom, Radau5, Radau9, Rk4, Rodas5p, Ros2, Taylor, Tolerances,
};
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::Model;

use crate::{Drive, DriveInputs, DriveParameters, Fault};

/// Writes for each method its name, its steps and the bits of the states after 50 ms at 12 V.
///
/// # Errors
/// Parameters that cannot be, a place that takes no text.
pub fn methods(out: &mut impl Write) -> Result<(), Fault> {
    run(out, Rk4::new(1e-4))?;
    run(out, Bs5::new())?;
    run(out, Cfmr7::new())?;
    run(out, Dop853::new())?;
    run(out, Nystrom::new())?;
    run(out, Taylor::new())?;
    run(out, Ros2::new(1e-3))?;
    run(out, Rodas5p::new())?;
    run(out, Ark5::new())?;
    run(out, Radau5::new())?;
    run(out, Radau9::new())?;
    run(out, Gauss6::new(1e-3))?;
    run(out, Auto::new())
}

fn run(out: &mut impl Write, mut method: impl Method) -> Result<(), Fault> {
    let inputs = DriveInputs { voltage: Input::constant(12.0), ..DriveInputs::default() };
    let model = Drive::new(DriveParameters::default(), inputs)?;
    let settings = Settings { tolerances: Tolerances::new(1e-8, 1e-10), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 0.05 };
    write!(out, "{:8}", method.name())?;
    match integrate(&model, &mut method, &model.start()?, span, &settings, &mut ()) {
        Ok(finish) => {
            write!(out, " {:3}", finish.statistics.steps)?;
            finish.x.iter().try_for_each(|state| write!(out, " {:016x}", state.to_bits()))?;
        }
        Err(_) => write!(out, " fails")?,
    }
    Ok(writeln!(out)?)
}
