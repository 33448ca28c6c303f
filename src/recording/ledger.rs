//! The ledger: what each phase took from the energy and the momentum, and gave to them.

use serde::Serialize;

use crate::physics::Vector3;

/// Who takes and gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Account {
    /// Impacts of spheres.
    Contacts,
    /// Impacts on walls, and walls that are leant on.
    Cushions,
    /// Stops of slow bodies.
    Rest,
    /// Moving overlapping surfaces apart.
    PushOut,
    /// Drag.
    Drag,
    /// Dampers of springs.
    Dampers,
    /// Uniform gravity: momentum alone, its energy being potential.
    Gravity,
    /// What the integrator's motion changes beyond all that: its error.
    Integrator,
}

impl Account {
    /// Every account.
    pub const ALL: [Self; 8] = [
        Self::Contacts,
        Self::Cushions,
        Self::Rest,
        Self::PushOut,
        Self::Drag,
        Self::Dampers,
        Self::Gravity,
        Self::Integrator,
    ];

    /// The name in tables and sentences.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Contacts => "contacts",
            Self::Cushions => "cushions",
            Self::Rest => "rest",
            Self::PushOut => "push-out",
            Self::Drag => "drag",
            Self::Dampers => "dampers",
            Self::Gravity => "gravity",
            Self::Integrator => "integrator",
        }
    }
}

/// A change of the energy and of the momentum. Units: kg times scene length unit squared per
/// second squared, and kg times scene length unit per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// Added to kinetic and potential energy together.
    pub energy: f64,
    /// Added to the momentum.
    pub momentum: Vector3,
}

impl Entry {
    /// Nothing.
    pub const NONE: Self = Self {
        energy: 0.0,
        momentum: Vector3::new(0.0, 0.0, 0.0),
    };
}

/// What was booked since the start. The sum over all accounts is `E(t) - E(0)` and `p(t) - p(0)`,
/// to the rounding of the steps on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ledger {
    entries: [Entry; Account::ALL.len()],
    /// Sum of the sizes of all changes of the energy: what rounding is measured against.
    pub turnover: f64,
}

impl Default for Ledger {
    fn default() -> Self {
        Self {
            entries: [Entry::NONE; Account::ALL.len()],
            turnover: 0.0,
        }
    }
}

impl Ledger {
    /// Books an entry.
    pub fn book(&mut self, account: Account, entry: Entry) {
        let own = &mut self.entries[account as usize];
        own.energy += entry.energy;
        own.momentum += entry.momentum;
        self.turnover += entry.energy.abs();
    }

    /// What an account has come to.
    #[must_use]
    pub fn of(&self, account: Account) -> Entry {
        self.entries[account as usize]
    }

    /// All accounts together.
    #[must_use]
    pub fn sum(&self) -> Entry {
        self.entries.iter().fold(Entry::NONE, |sum, entry| Entry {
            energy: sum.energy + entry.energy,
            momentum: sum.momentum + entry.momentum,
        })
    }

    /// The account that gave most energy, if any gave some.
    #[must_use]
    pub fn largest_giver(&self) -> Option<Account> {
        let gives = |account: &Account| self.of(*account).energy > 0.0;
        let by_energy =
            |a: &Account, b: &Account| self.of(*a).energy.total_cmp(&self.of(*b).energy);
        Account::ALL.into_iter().filter(gives).max_by(by_energy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accounts_add_up_and_the_giver_is_named() {
        let mut ledger = Ledger::default();
        let entry = |energy| Entry {
            energy,
            momentum: Vector3::x(),
        };
        for (place, account) in Account::ALL.into_iter().enumerate() {
            assert_eq!(account as usize, place);
        }
        ledger.book(Account::Drag, entry(-3.0));
        ledger.book(Account::PushOut, entry(1.0));
        ledger.book(Account::PushOut, entry(1.5));
        assert_eq!(ledger.sum().energy, -0.5);
        assert_eq!(ledger.sum().momentum, Vector3::x() * 3.0);
        assert_eq!(ledger.turnover, 5.5);
        assert_eq!(ledger.largest_giver(), Some(Account::PushOut));
    }
}
