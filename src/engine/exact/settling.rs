//! Flights until bodies come to lie on each other, then the forces that they press with.

use super::flight::FlightSimulation;
use super::forces::ForcesSimulation;
use crate::engine::Simulation;
use crate::physics::BodyState;
use crate::recording::{EventLog, Outcome, Work};

/// Closed-form flights, and the integrator from the instant on at which bounces pile up.
///
/// Only the integrator knows contacts that last; only flights are free of steps.
pub(super) struct SettlingSimulation {
    flight: FlightSimulation<f64>,
    forces: ForcesSimulation<f64>,
    lies: bool,
}

impl SettlingSimulation {
    pub(super) fn new(flight: FlightSimulation<f64>, forces: ForcesSimulation<f64>) -> Self {
        Self {
            flight,
            forces,
            lies: false,
        }
    }
}

impl Simulation for SettlingSimulation {
    fn advance_to(&mut self, sample: usize, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if !self.lies {
            let halt = self.flight.advance_to(sample, log.as_deref_mut());
            if !matches!(halt, Some(Outcome::Collapsed { .. })) {
                return halt;
            }
            let (time, states) = self.flight.here();
            self.forces.go_on_from(time, &states);
            self.lies = true;
        }
        self.forces.advance_to(sample, log)
    }

    fn state_into(&self, into: &mut [BodyState]) {
        if self.lies {
            self.forces.state_into(into);
        } else {
            self.flight.state_into(into);
        }
    }

    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.lies = false;
        self.flight.set_state(sample, states);
        self.forces.set_state(sample, states);
    }

    fn work(&self) -> Work {
        let (flight, forces) = (self.flight.work(), self.forces.work());
        Work {
            steps: flight.steps + forces.steps,
            pair_tests: flight.pair_tests + forces.pair_tests,
            force_evaluations: forces.force_evaluations,
            solving: flight.solving + forces.solving,
        }
    }
}
