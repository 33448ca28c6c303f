//! `carom scenes`: list, show, start, generate.

use std::path::{Path, PathBuf};

use clap::Subcommand;

use super::args::LibraryArgs;
use super::output::{say, say_json, say_lines};
use crate::case::{Evidence, Library, scene_text};
use crate::error::{Error, Result};
use crate::report::write_file;
use crate::scene::check::check_scene_name;
use crate::scene::generate::{Cluster, Gas, Rack};
use crate::scene::{Scene, parse, to_toml};

/// A scene to start from: small, complete, every effect mentioned.
const STARTER: &str = include_str!("../../templates/starter.toml");

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// List the cases
    List {
        #[command(flatten)]
        library: LibraryArgs,
        /// List the hard cases instead
        #[arg(long, conflicts_with = "reference")]
        hard: bool,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the scene file of a case
    Show {
        /// Name of the case
        case: String,
        #[command(flatten)]
        library: LibraryArgs,
    },
    /// Write a small scene file to start from
    New {
        /// Name of the scene, a-z, 0-9 and `-`
        name: String,
        #[command(flatten)]
        out: Out,
    },
    /// Generate a scene from a recipe and a seed
    Generate {
        #[command(subcommand)]
        recipe: Recipe,
    },
}

#[derive(Debug, clap::Args)]
struct Out {
    /// The file to write
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

#[derive(Debug, Subcommand)]
enum Recipe {
    /// The lecture's random cluster of attracting spheres
    Cluster {
        /// Number of spheres
        #[arg(long, default_value_t = Cluster::default().count)]
        count: usize,
        /// Radius of the ball that holds their centres, m
        #[arg(long, default_value_t = Cluster::default().extent, allow_negative_numbers = true)]
        extent: f64,
        /// Seed of the random numbers
        #[arg(long, default_value_t = Cluster::default().seed)]
        seed: u64,
        #[command(flatten)]
        out: Out,
    },
    /// A rack of balls on the lecture's table, and a cue ball
    Rack {
        /// Rows of the triangle
        #[arg(long, default_value_t = Rack::default().rows)]
        rows: usize,
        /// Free distance between neighbours, mm
        #[arg(long, default_value_t = Rack::default().gap, allow_negative_numbers = true)]
        gap: f64,
        /// Each ball is moved by up to this much, mm
        #[arg(long, default_value_t = Rack::default().jitter, allow_negative_numbers = true)]
        jitter: f64,
        /// Seed of the jitter
        #[arg(long, default_value_t = Rack::default().seed)]
        seed: u64,
        #[command(flatten)]
        out: Out,
    },
    /// An elastic gas on a face-centred cubic lattice in a closed box
    Gas {
        /// Lattice cells an edge; 4 spheres a cell
        #[arg(long, default_value_t = Gas::default().cells)]
        cells: usize,
        /// Number of spheres; they thin out the smallest lattice that has so many places
        #[arg(long, conflicts_with = "cells")]
        count: Option<usize>,
        /// Filling fraction
        #[arg(long, default_value_t = Gas::default().filling, allow_negative_numbers = true)]
        filling: f64,
        /// Seed of the velocities
        #[arg(long, default_value_t = Gas::default().seed)]
        seed: u64,
        #[command(flatten)]
        out: Out,
    },
}

pub(super) fn run(args: &Args) -> Result<()> {
    match &args.what {
        What::List {
            hard: true, json, ..
        } => list(&Library::hard(), *json),
        What::List { library, json, .. } => list(&library.library(), *json),
        What::Show { case, library } => say_lines(scene_text(case, &library.library())?.trim_end()),
        What::New { name, out } => {
            check_scene_name(name).map_err(|wrong| Error::Scene {
                scene: name.clone(),
                message: wrong.to_string(),
            })?;
            let text = STARTER.replacen("my-scene", name, 1);
            parse(&text, "the new scene")?;
            let file = out
                .out
                .clone()
                .unwrap_or_else(|| PathBuf::from(format!("{name}.toml")));
            write(&file, out.force, &text)?;
            say(format_args!(
                "{} written; try `carom run {0}`",
                file.display()
            ))
        }
        What::Generate { recipe } => generate(recipe),
    }
}

#[derive(serde::Serialize)]
struct Listed {
    name: String,
    title: String,
    bodies: usize,
    duration_s: f64,
    truth: Option<Evidence>,
}

fn list(library: &Library, json: bool) -> Result<()> {
    let listed = library
        .names()?
        .into_iter()
        .map(|name| {
            let case = library.case(&name)?;
            Ok(Listed {
                name,
                title: case.scene.heading().to_owned(),
                bodies: case.scene.bodies.len(),
                duration_s: case.scene.duration,
                truth: case.evidence,
            })
        })
        .collect::<Result<Vec<_>>>()?;
    if json {
        return say_json(&listed);
    }
    let widest = listed.iter().map(|row| row.name.len()).max().unwrap_or(0);
    for row in &listed {
        let truth = match row.truth {
            Some(Evidence::Independent) => "truth",
            Some(Evidence::Own) => "exact",
            None => "",
        };
        say(format_args!(
            "{:<widest$}  {:<5}  {}",
            row.name, truth, row.title
        ))?;
    }
    Ok(())
}

fn generate(recipe: &Recipe) -> Result<()> {
    let (scene, out): (Scene, &Out) = match recipe {
        Recipe::Cluster {
            count,
            extent,
            seed,
            out,
        } => {
            let recipe = Cluster {
                count: *count,
                extent: *extent,
                seed: *seed,
                ..Cluster::default()
            };
            (recipe.scene()?, out)
        }
        Recipe::Rack {
            rows,
            gap,
            jitter,
            seed,
            out,
        } => {
            let recipe = Rack {
                rows: *rows,
                gap: *gap,
                jitter: *jitter,
                seed: *seed,
                ..Rack::default()
            };
            (recipe.scene()?, out)
        }
        Recipe::Gas {
            cells,
            count,
            filling,
            seed,
            out,
        } => {
            let recipe = Gas {
                cells: *cells,
                filling: *filling,
                seed: *seed,
            };
            let scene = match count {
                Some(count) => Gas::thinned(*count, *filling, *seed)?,
                None => recipe.scene()?,
            };
            (scene, out)
        }
    };
    let text = to_toml(&scene)?;
    let Some(file) = &out.out else {
        return say_lines(text.trim_end());
    };
    write(file, out.force, &text)
}

/// Writes a scene file, but never over another one without being told to.
fn write(file: &Path, force: bool, text: &str) -> Result<()> {
    if file.is_dir() || file.file_name().is_none() {
        return Err(Error::Argument {
            argument: "out",
            found: file.display().to_string(),
            remedy: "that is a folder; name a file in it".into(),
        });
    }
    write_file(file, force, text.as_bytes())
}
