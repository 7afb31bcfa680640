//! What the observer knows of what nothing measures, and what a sample costs.

use bg_model::fixed_step::operations;
use bg_model::mechanism::Mechanism;
use bg_model::scalar::Scalar;
use motor_observer::{Bench, Drive, DriveParameters, Estimator, Fault};

/// What two seconds tell: the root mean square of what the estimated speed of the load differs from the machine's,
/// rad/s, and the torque that the observer makes of it at the end, N*m.
fn told<S: Scalar<Switch = bool>>(parameters: DriveParameters) -> Result<[f64; 2], Fault> {
    let (mut bench, mut estimator) = (Bench::new()?, Estimator::<S>::new(parameters)?);
    let (mut sum, mut torque) = (0.0, 0.0);
    for _ in 0..2000 {
        let measured = bench.sample()?;
        estimator.sample(&measured)?;
        let ([.., load], [.., estimated, unknown]) = (bench.outputs(), estimator.outputs());
        sum += (estimated.to_f64() - load).powi(2);
        torque = unknown.to_f64();
    }
    Ok([(sum / 2000.0).sqrt(), torque])
}

#[test]
fn the_observer_finds_what_it_does_not_know() -> Result<(), Fault> {
    let alone = DriveParameters { current_gain: 0.0, speed_gain: 0.0, torque_gain: 1e-9, ..DriveParameters::default() };
    let ([without, _], [with, torque]) = (told::<f64>(alone)?, told::<f64>(DriveParameters::default())?);
    let [single, single_torque] = told::<f32>(DriveParameters::default())?;
    println!("off by {without:.3} rad/s without corrections, {with:.3} with; {torque:.3} N*m act on the load");
    println!("in f32 off by {single:.3} rad/s; {single_torque:.3} N*m");
    assert!(without > 0.5 && with < without / 4.0, "{without} {with}");
    assert!((torque + 0.8).abs() < 0.02, "{torque}");
    assert!((single - with).abs() < 1e-3 * with && (single_torque - torque).abs() < 1e-3, "{single} {single_torque}");
    Ok(())
}

#[test]
fn nothing_is_allocated() -> Result<(), Fault> {
    let mut bench = Bench::new()?;
    let measured = bench.sample()?;
    let mut outcome = Ok(());
    let counted = allocation_counter::measure(|| {
        outcome = Estimator::<f64>::new(DriveParameters::default())
            .and_then(|mut estimator| (0..1000).try_for_each(|_| estimator.sample(&measured)).map_err(Fault::from));
    });
    outcome?;
    assert_eq!(counted.count_total, 0);
    Ok(())
}

#[test]
fn a_sample_takes_so_many_operations() {
    let count = operations(Drive::describe()).expect("no iteration");
    assert_eq!([count.additions, count.multiplications, count.divisions, count.functions], [90, 122, 0, 4]);
}
