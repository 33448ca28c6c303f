//! The command line as a user types it.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

/// Runs carom in a folder and gives what it prints.
pub fn carom(folder: &Path, arguments: &[&str]) -> String {
    let mut command = Command::cargo_bin("carom").unwrap();
    let output = command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_plan_lists_what_the_scene_calls_for_and_nothing_else() {
    let scratch = tempfile::tempdir().unwrap();
    let phases = |case: &str| {
        let text = carom(
            scratch.path(),
            &["plan", case, "--engine", "lecture", "--json"],
        );
        let plans: serde_json::Value = serde_json::from_str(&text).unwrap();
        let phases = plans[0]["phases"].as_array().unwrap().clone();
        phases
            .iter()
            .map(|p| p["name"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(phases("headon-equal"), ["drift", "contacts"]);
    assert_eq!(
        phases("shot-2-61"),
        [
            "clear", "drag", "kick", "drift", "rest", "cushions", "contacts"
        ]
    );
    assert_eq!(
        phases("kepler-e06"),
        ["clear", "attraction", "kick", "drift"]
    );
    assert_eq!(
        phases("spring-under"),
        ["clear", "springs", "kick", "drift"]
    );
}

#[test]
fn scenes_are_listed_shown_started_and_generated() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let list = carom(folder, &["scenes", "list", "--json"]);
    let list: serde_json::Value = serde_json::from_str(&list).unwrap();
    assert!(list.as_array().unwrap().len() >= 18);
    assert!(carom(folder, &["scenes", "show", "shot-2-96"]).contains("[effects.cushions]"));
    carom(folder, &["scenes", "new", "mine"]);
    carom(
        folder,
        &[
            "run",
            "mine.toml",
            "--engine",
            "lecture",
            "--quiet",
            "--out",
            "out",
        ],
    );
    let recipes: [&[&str]; 4] = [
        &["cluster", "--count", "8"],
        &["rack", "--jitter", "0.1"],
        &["gas", "--cells", "2"],
        &["gas", "--count", "10", "--filling", "0.1"],
    ];
    for recipe in recipes {
        let make = |seed: &'static str| {
            carom(
                folder,
                &[&["scenes", "generate"], recipe, &["--seed", seed]].concat(),
            )
        };
        assert_eq!(make("7"), make("7"), "the same seed, the same scene");
        assert_ne!(make("7"), make("8"), "another seed, another scene");
        carom::scene::parse(&make("7"), "generated").unwrap();
    }
}

#[test]
fn a_new_scene_never_replaces_a_file_unasked() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("mine.toml"), "precious").unwrap();
    let mut command = Command::cargo_bin("carom").unwrap();
    command
        .current_dir(scratch.path())
        .args(["scenes", "new", "mine"])
        .assert()
        .code(2);
    assert_eq!(
        fs::read_to_string(scratch.path().join("mine.toml")).unwrap(),
        "precious"
    );
    carom(scratch.path(), &["scenes", "new", "mine", "--force"]);
}

/// Every file below a folder, by its path.
pub fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push((
                path.to_string_lossy().into_owned(),
                fs::read(&path).unwrap(),
            ));
        }
    }
    found.sort();
    found
}

#[test]
fn a_report_is_whole_and_the_same_every_time() {
    let scratch = tempfile::tempdir().unwrap();
    let cases = ["headon-equal", "shot-2-96", "spring-under", "cluster-8"];
    let report = || {
        carom(
            scratch.path(),
            &[&["report"], &cases[..], &["--quiet"]].concat(),
        );
        files(&scratch.path().join("reports"))
    };
    let first = report();
    assert!(first == report(), "the same cases gave other files");
    let page = fs::read_to_string(scratch.path().join("reports/README.md")).unwrap();
    let summary = fs::read_to_string(scratch.path().join("reports/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["cases"].as_array().unwrap().len(), cases.len());
    for case in cases {
        let folder = scratch.path().join("reports").join(case);
        if cfg!(feature = "plots") {
            for picture in ["paths.png", "divergence.png", "energy.png", "momentum.png"] {
                let bytes = fs::read(folder.join(picture)).unwrap();
                assert!(bytes.starts_with(b"\x89PNG\r\n"), "{case}/{picture}");
            }
        }
        let own = fs::read_to_string(folder.join("README.md")).unwrap();
        let is_cluster = own.contains("| time of collapse |");
        assert_eq!(is_cluster, case == "cluster-8", "{case}");
        let metrics = fs::read_to_string(folder.join("metrics.csv")).unwrap();
        assert!(metrics.starts_with(
            "time,engine,kinetic_energy,potential_energy,total_energy,momentum_x,momentum_y,\
             momentum_z,angular_momentum_x,"
        ));
        assert!(
            metrics
                .lines()
                .next()
                .unwrap()
                .ends_with(",max_penetration")
        );
        let divergence = fs::read_to_string(folder.join("divergence.csv")).unwrap();
        assert!(divergence.starts_with(
            "time,engine_a,engine_b,rms_position,max_position,worst_body,rms_velocity,\
             energy_difference,momentum_difference,angular_momentum_difference\n"
        ));
        if cfg!(feature = "rapier") {
            assert!(
                page.contains(&format!("[{case}]({case}/README.md)")),
                "{case}"
            );
        }
    }
    assert_links(&first);
}

/// Every link of every page leads to a file; a place within a page stands in that page.
pub fn assert_links(files: &[(String, Vec<u8>)]) {
    for (name, bytes) in files.iter().filter(|(name, _)| name.ends_with(".md")) {
        let text = String::from_utf8(bytes.clone()).unwrap();
        let after = |mark| text.split(mark).skip(1);
        let links = after("](").chain(after("src=\""));
        for link in links.filter_map(|rest| rest.split([')', '"']).next()) {
            if link.starts_with("http") {
                continue;
            }
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => Path::new(name).to_owned(),
                file => Path::new(name).parent().unwrap().join(file),
            };
            assert!(target.exists(), "{name}: {link}");
            if !place.is_empty() {
                let page = fs::read_to_string(&target).unwrap();
                let anchor = format!("<a id=\"{place}\"></a>");
                assert!(page.contains(&anchor), "{name}: {link}");
            }
        }
    }
}

/// The header is what programs read; every run has its row, those beyond the budget included.
#[test]
fn the_study_of_cost_leaves_every_point_and_a_page() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let study = |out: &str| {
        let arguments = [
            "cost",
            "headon-equal",
            "kepler-circle",
            "--engine",
            "lecture,exact-fast",
            "--repetitions",
            "1",
            "--budget",
            "3000",
            "--quiet",
            "--out",
            out,
        ];
        assert_eq!(carom(folder, &arguments), "");
        let read = |name: &str| fs::read_to_string(folder.join(out).join(name)).unwrap();
        (read("cost.csv"), read("orders.csv"), read("README.md"))
    };
    let (cost, orders, page) = study("a");
    let rows: Vec<Vec<&str>> = cost.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(
        rows[0].join(","),
        "scene,engine,setting,dt,position_error_rms,position_error_max,event_time_error,\
         energy_error,local_error,cost_ms_per_sim_s,cost_min_ms_per_sim_s,steps,outcome"
    );
    for scene in ["headon-equal", "kepler-circle"] {
        let of = |engine: &str| {
            let rows = rows
                .iter()
                .filter(|row| row[0] == scene && row[1] == engine);
            rows.cloned().collect::<Vec<_>>()
        };
        let lecture = of("lecture");
        let (last, ran) = lecture.split_last().unwrap();
        assert_eq!(last[4..], ["", "", "", "", "", "", "", "", "BudgetSpent"]);
        assert!(ran.len() >= 2, "{ran:?}");
        for row in ran {
            assert!(row[5].parse::<f64>().unwrap() >= 0.0, "{row:?}");
            assert!(row[9].parse::<f64>().unwrap() > 0.0, "{row:?}");
            assert_eq!(row[12], "Finished");
        }
        let [exact] = &of("exact-fast")[..] else {
            panic!("one point without a step");
        };
        assert_eq!(exact[3], "");
        assert!(exact[5].parse::<f64>().unwrap() < 1e-9, "{exact:?}");
        assert!(page.contains(&format!("work-precision-{scene}.png")) == cfg!(feature = "plots"));
        let picture = folder.join("a").join(format!("work-precision-{scene}.png"));
        assert_eq!(picture.exists(), cfg!(feature = "plots"));
    }
    assert!(orders.starts_with("scene,engine,error,order,low,high,stated_order,points\n"));
    let read = |name: &str| fs::read_to_string(folder.join("a").join(name)).unwrap();
    let phases = read("phases.csv");
    assert!(phases.starts_with(
        "scene,engine,shift_s,dt,position_error_rms,position_error_max,event_time_error,\
         energy_error,local_error,outcome\n"
    ));
    // Every run of the lecture again, from seven later starts.
    let of_lecture = |table: &str| {
        table
            .lines()
            .filter(|line| line.contains(",lecture,"))
            .count()
    };
    assert_eq!(of_lecture(&phases), 7 * of_lecture(&cost));
    assert!(read("limits.csv").starts_with(
        "scene,engine,kind,limit,limit_low,limit_high,slope,finest,floor\nheadon-equal,lecture,"
    ));
    let push_out = read("push-out.csv");
    assert!(push_out.starts_with(
        "scene,engine,without,dt,cost_ratio,cost_ratio_low,cost_ratio_high,position_error_max,\
         position_error_max_without,energy_added,max_penetration,max_penetration_without\n"
    ));
    // Nothing meets in kepler-circle.
    assert!(push_out.contains("headon-equal,lecture,lecture-in-place,"));
    assert!(!push_out.contains("kepler-circle"));
    assert!(page.contains("Push-out, priced separately"));
    assert!(page.contains("The price tag"));
    // Two bodies, every step one pair: k = 1, 2, ... steps a sample, 32 samples a second.
    let work = fs::read_to_string(folder.join("a/work.csv")).unwrap();
    assert!(work.starts_with(
        "scene,engine,setting,dt,steps_per_sim_s,force_evaluations_per_sim_s,pair_tests_per_sim_s\n"
    ));
    let row = work.lines().nth(1).unwrap();
    assert_eq!(row, "headon-equal,lecture,stock,0.03125,32.0,0.0,32.0");
    assert!(page.contains("fixed, ns a step"));
    // What is counted and computed is the same again; only prices differ.
    let counted = |table: &str| -> Vec<String> {
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            [&cells[..9], &cells[11..]].concat().join(",")
        };
        table.lines().map(row).collect()
    };
    assert_eq!(counted(&cost), counted(&study("b").0));
}

/// Every engine has its row at every number of bodies; the rows of another build stand beside.
#[test]
fn cost_against_bodies_leaves_every_point_and_takes_in_other_builds() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let study = [
        "cost",
        "--bodies",
        "30,4,10",
        "--engine",
        "lecture,exact-fast",
    ];
    let quick = ["--repetitions", "1", "--budget", "2000"];
    let said = carom(folder, &[&study[..], &quick].concat());
    assert!(
        said.contains("bodies  4 ") && said.contains("over budget"),
        "{said}"
    );
    let own = folder.join("runs/bodies");
    let table = fs::read_to_string(own.join("bodies.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(
        rows[0].join(","),
        "build,engine,bodies,dt,filling,walls,seed,step_us,step_min_us,cost_ms_per_sim_s,steps,\
         force_evaluations,pair_tests,ratio,ratio_low,ratio_high,outcome,machine"
    );
    assert_eq!(rows.len(), 1 + 6);
    assert_eq!(rows[1][1..6], ["lecture", "4", "0.01", "0.1", "closed"]);
    let thirty = rows
        .iter()
        .find(|row| row[1..3] == ["lecture", "30"])
        .unwrap();
    assert_eq!(thirty[7..16], ["", "", "", "", "", "", "", "", ""]);
    assert_eq!(thirty[16], "BudgetSpent");
    assert!(rows[1][7].parse::<f64>().unwrap() > 0.0);
    let page = fs::read_to_string(own.join("README.md")).unwrap();
    assert!(page.contains("What is fixed, and what each body and pair adds"));
    assert_eq!(
        own.join("cost-bodies.png").exists(),
        cfg!(feature = "plots")
    );
    // The same table again is of the build that is here; under another name it is joined.
    let other = table.replace(&format!("\n{},", rows[1][0]), "\nother,");
    fs::write(folder.join("other.csv"), other).unwrap();
    let joined = [&study[..], &quick, &["--out", "b", "--join", "other.csv"]].concat();
    let said = carom(folder, &joined);
    assert!(said.contains("lecture (other)"), "{said}");
    let table = fs::read_to_string(folder.join("b/bodies.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 12);
    for (arguments, remedy) in [
        (&["--join", "runs/bodies/bodies.csv"][..], "other builds"),
        (&["--join", "missing.csv"], "cannot be read"),
        (&["--join", "other.csv", "--dt", "0.02"], "the same --dt"),
        (&["--join", "other.csv", "--open"], "`closed`"),
        (&["--dt", "-1"], "above 0"),
        (&["--filling", "0.9"], "close packing"),
    ] {
        let mut command = Command::cargo_bin("carom").unwrap();
        let output = command
            .current_dir(folder)
            .args([&study[..], &quick, &["--out", "c"], arguments].concat())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let complaint: Vec<_> = said
            .lines()
            .filter(|line| line.starts_with("error"))
            .collect();
        assert_eq!(
            (output.status.code(), complaint.len()),
            (Some(2), 1),
            "{said}"
        );
        assert!(said.contains(remedy), "{said}");
    }
}

#[test]
fn the_study_of_cost_says_what_it_cannot_do() {
    let scratch = tempfile::tempdir().unwrap();
    for (arguments, remedy) in [
        (["--repetitions", "0"], "give 1 to 10000"),
        (["--phases", "2"], "give 3 to 1000"),
        (["--engine", "exact"], "exact-fast"),
    ] {
        let mut command = Command::cargo_bin("carom").unwrap();
        let output = command
            .current_dir(scratch.path())
            .args(["cost", "headon-equal"])
            .args(arguments)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(remedy), "{said}");
    }
}
