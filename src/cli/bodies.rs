//! `carom cost --bodies`: what a step costs as the number of bodies grows.

use std::path::{Path, PathBuf};

use super::output::{progress, say, say_lines, warn};
use crate::engine::{DEFAULT_DT, EngineSpec};
use crate::error::{Error, Result};
use crate::report::{BODIES_FILES, Output, Replace, bodies_findings, bodies_table, write_bodies};
use crate::scene::BODIES_MAX;
use crate::study::Timing;
use crate::study::bodies::{BodiesOptions, BodiesStudy, Walls, bodies_cost, joined};

/// What the study of numbers of bodies is asked beyond what every study of cost is.
#[derive(Debug, clap::Args)]
pub(super) struct BodiesArgs {
    /// Instead of scenes: a gas of each of these numbers of bodies, at the same density
    #[arg(
        long = "bodies",
        value_name = "NUMBERS",
        value_delimiter = ',',
        num_args = 0..=1,
        default_missing_value = "4,10,30,100,300,1000,3000,10000",
        conflicts_with = "scenes"
    )]
    pub sizes: Vec<usize>,
    /// Step of the engines, s; with --bodies
    #[arg(long, value_name = "SECONDS", default_value_t = DEFAULT_DT, allow_negative_numbers = true)]
    dt: f64,
    /// Share of the box that the spheres fill; with --bodies
    #[arg(
        long,
        value_name = "SHARE",
        default_value_t = 0.1,
        allow_negative_numbers = true
    )]
    filling: f64,
    /// Take the walls away before the clock starts; with --bodies
    #[arg(long)]
    open: bool,
    /// A bodies.csv that another build of carom has measured, to stand beside; with --bodies
    #[arg(long = "join", value_name = "FILE")]
    joined: Vec<PathBuf>,
}

/// Work a run may take unless told otherwise: six steps of 10,000 bodies, all pairs.
const BUDGET: u64 = 300_000_000;

impl BodiesArgs {
    /// Makes the study.
    pub fn run(
        &self,
        specs: &[EngineSpec],
        timing: Timing,
        budget: Option<u64>,
        (out, replace): (&Path, Replace),
        quiet: bool,
    ) -> Result<()> {
        if !(self.dt.is_finite() && self.dt > 0.0) {
            return Err(Error::Step {
                dt: self.dt,
                message: "give a finite number above 0".into(),
            });
        }
        let options = BodiesOptions {
            sizes: self.sizes()?,
            dt: self.dt,
            filling: self.filling,
            walls: if self.open {
                Walls::Open
            } else {
                Walls::Closed
            },
            timing,
            budget: budget.unwrap_or(BUDGET),
        };
        // Before the long run, so that a wrong file is told at once.
        let others = joined(&self.joined, &options)?;
        let output = Output::open(out, replace)?;
        let folder = output.folder();
        folder.claim(BODIES_FILES)?;
        folder.unfinished().claim(BODIES_FILES)?;
        let bar = progress(1, quiet);
        let watch = |bodies: usize, done: usize, all: usize| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
            bar.set_message(format!("{bodies} bodies"));
        };
        // After each size, so that an interrupted study leaves what it has found.
        let keep = |study: &BodiesStudy| {
            let mut so_far = study.clone();
            so_far.points.extend_from_slice(&others);
            folder.keep_unfinished(|folder| write_bodies(folder, &so_far))
        };
        let mut study = bodies_cost(specs, &options, &watch, &keep)?;
        bar.finish_and_clear();
        study.points.extend_from_slice(&others);
        write_bodies(&folder, &study)?;
        output.commit()?;
        if study.machine.is_busy() {
            warn(
                "something else ran when the study began, or had just ended; ratios hold better \
                 than prices",
            );
        }
        for refusal in &study.refusals {
            warn(format_args!("{}: {}", refusal.engine, refusal.reason));
        }
        if quiet {
            return Ok(());
        }
        say_lines(bodies_table(&study))?;
        for finding in bodies_findings(&study) {
            say(finding)?;
        }
        say(format_args!(
            "Written to {}",
            out.join("README.md").display()
        ))
    }

    /// The numbers of bodies, ascending, each once.
    fn sizes(&self) -> Result<Vec<usize>> {
        let mut sizes = self.sizes.clone();
        sizes.sort_unstable();
        sizes.dedup();
        match sizes.iter().find(|size| !(1..=BODIES_MAX).contains(*size)) {
            Some(size) => Err(Error::Argument {
                argument: "bodies",
                found: size.to_string(),
                remedy: format!("give 1 to {BODIES_MAX}"),
            }),
            None => Ok(sizes),
        }
    }
}
