//! What a choice between methods, or a method built on another one, leaves to the one inside.

/// Methods of [`Method`](super::Method) that hand on to the method inside: `present!((BORROW) self, method => ..)`
/// calls it, borrowed as `BORROW`.
macro_rules! hand_on {
    ($present:ident) => {
        fn name(&self) -> &'static str {
            $present!((&) self, method => method.name())
        }

        fn control(&self) -> StepControl {
            $present!((&) self, method => method.control())
        }

        fn measures(&self) -> bool {
            $present!((&) self, method => method.measures())
        }

        fn error_alone(&self) -> f64 {
            $present!((&) self, method => method.error_alone())
        }

        fn error_after(
            &mut self,
            flow: &Flow<'_>,
            start: PointRef<'_>,
            h: f64,
            scale: &Scale,
            end: &[f64],
            project: &dyn Fn(&mut [f64]),
        ) -> Option<f64> {
            $present!((&mut) self, method => method.error_after(flow, start, h, scale, end, project))
        }

        fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
            $present!((&) self, method => method.largest_error(start, scale, end))
        }

        fn faulty_rate(&self) -> Option<(usize, f64)> {
            $present!((&) self, method => method.faulty_rate())
        }

        fn prepare_dense(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>) {
            $present!((&mut) self, method => method.prepare_dense(flow, start, h, end));
        }

        fn prepare_samples(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>, scale: &Scale) {
            $present!((&mut) self, method => method.prepare_samples(flow, start, h, end, scale));
        }

        fn sample(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
            $present!((&) self, method => method.sample(start, h, end, theta, x));
        }

        fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
            $present!((&) self, method => method.dense(start, h, end, theta, x));
        }
    };
}

pub(super) use hand_on;
