//! A profile written into the text of an `expected.toml`, which keeps all else that it says.

use toml_edit::{DocumentMut, InlineTable, Item, Table, value};

use super::Profile;

/// Stands at the top of a file that is begun here.
const HEADING: &str = "\
# What each engine is known to do on this case, and how far from that it may be. Written by
# `carom check --bless`, which derives every tolerance; `topic` and bounds are set by hand.
";

/// Puts a profile into the text of an `expected.toml`, or begins one; bounds, topic and comments
/// stay as they are.
///
/// # Errors
/// The text is not TOML, or holds something else where profiles stand.
pub fn with_profile(
    text: Option<&str>,
    name: &str,
    profile: &Profile,
) -> Result<String, toml_edit::TomlError> {
    let mut document: DocumentMut = text.unwrap_or(HEADING).parse()?;
    let profiles = document.entry("profile").or_insert_with(|| {
        let mut table = Table::new();
        table.set_implicit(true);
        Item::Table(table)
    });
    let mut table = Table::new();
    table["made"] = value(&profile.made);
    table["dt"] = value(profile.dt);
    table["digest"] = value(&profile.digest);
    for (key, tolerances) in profile.comparisons() {
        let Some(tolerances) = tolerances else {
            continue;
        };
        let mut of = Table::new();
        of["until"] = value(tolerances.until);
        for (metric, tolerance) in tolerances.all() {
            let mut line = InlineTable::new();
            line.insert("value", tolerance.value.into());
            line.insert("tolerance", tolerance.tolerance.into());
            line.insert("why", tolerance.why.as_str().into());
            of[metric.key()] = value(line);
        }
        table[key] = Item::Table(of);
    }
    profiles[name] = Item::Table(table);
    Ok(document.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{Expected, Metric, Tolerance, Tolerances};

    #[test]
    fn what_stands_beside_a_profile_stays_and_the_profile_reads_back() {
        let scene = "name='x'\nduration=2\nsample_every=1\n[[bodies]]\nname='a'\nmass=1\n\
            radius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n";
        let scene = crate::scene::parse(scene, "x").unwrap();
        let mut truth = Tolerances::up_to(1.5);
        let tolerance = Tolerance {
            value: 1e-3,
            tolerance: 0.1 + 0.2,
            why: "\"so\" it is".to_owned(),
        };
        truth.set(Metric::AngularMomentum, tolerance);
        let profile = Profile {
            made: "here".to_owned(),
            dt: 0.01,
            digest: "ab".to_owned(),
            truth: Some(truth),
            baseline: None,
            rapier: None,
        };
        let before = "topic = 'flight' # mine\n[momentum]\nchange_max = 1e-9 # small\nwhy = 'so'\n";
        let mut text = with_profile(Some(before), "lecture", &profile).unwrap();
        text = with_profile(Some(&text), "a solver of mine", &profile).unwrap();
        assert!(text.starts_with(before), "{text}");
        let read = Expected::parse(&text, "x", &scene).unwrap();
        assert_eq!(read.profile["lecture"], profile);
        assert_eq!(read.profile["a solver of mine"], profile);
        assert_eq!(read.topic.as_deref(), Some("flight"));
    }
}
