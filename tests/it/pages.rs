//! Every page that a command writes, read as a Markdown parser reads it: its lists, tables, links
//! and pictures are those of the data beside it.

use std::collections::BTreeSet;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use serde_json::Value;

use crate::command_line::carom;

/// A table as the parser has it.
#[derive(Debug, Default)]
struct Table {
    /// `[row][cell]`, the header first.
    rows: Vec<Vec<String>>,
}

/// A block of a page, as far as it is compared with data.
#[derive(Debug)]
enum Block {
    Heading(String),
    /// With so many items, those of inner lists left out.
    List(usize),
    Table(Table),
}

/// A page with what is wrong with it as Markdown.
#[derive(Debug, Default)]
struct Page {
    blocks: Vec<Block>,
    faults: Vec<String>,
    /// Targets of links and pictures.
    targets: Vec<String>,
    /// Targets of pictures alone.
    pictures: Vec<String>,
}

/// Cells of a row in the source, by its bars; none where it is no row of a table.
fn cells_written(row: &str) -> Option<usize> {
    let row = row.trim().strip_prefix('|')?.strip_suffix('|')?;
    let bars = row.replace("\\|", "").matches('|').count();
    Some(bars + 1)
}

impl Page {
    fn parse(text: &str) -> Self {
        let mut page = Self::default();
        let mut depth = 0;
        let mut items = Vec::new();
        let mut words = String::new();
        let mut table = Table::default();
        let parser = Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter();
        for (event, range) in parser {
            match event {
                Event::Start(Tag::Heading { .. } | Tag::TableCell | Tag::Item) => {
                    words.clear();
                    if let (Some(last), true) = (items.last_mut(), text[range].starts_with('-')) {
                        *last += 1;
                    }
                }
                Event::Start(Tag::List(_)) => {
                    depth += 1;
                    items.push(0);
                }
                Event::End(TagEnd::List(_)) => {
                    depth -= 1;
                    let items = items.pop().unwrap();
                    if depth == 0 {
                        page.blocks.push(Block::List(items));
                    }
                }
                Event::End(TagEnd::Heading(_)) => {
                    page.blocks.push(Block::Heading(words.trim().to_owned()));
                }
                Event::Start(Tag::Table(_)) => table = Table::default(),
                Event::Start(Tag::TableHead | Tag::TableRow) => {
                    table.rows.push(Vec::new());
                    page.row(text, range, &table);
                }
                Event::End(TagEnd::TableCell) => {
                    table.rows.last_mut().unwrap().push(words.trim().to_owned());
                }
                Event::End(TagEnd::Table) => page.table(std::mem::take(&mut table)),
                Event::Start(Tag::Paragraph) => page.paragraph(&text[range]),
                Event::Start(Tag::Link { dest_url, .. }) => page.targets.push(dest_url.into()),
                Event::Start(Tag::Image { dest_url, .. }) => {
                    page.targets.push(dest_url.to_string());
                    page.pictures.push(dest_url.into());
                }
                Event::Text(said) | Event::Code(said) => words.push_str(&said),
                Event::InlineHtml(tag) | Event::Html(tag) => page.html(&tag),
                // The text of a case's own file, whose lines are as long as its writer made them.
                Event::SoftBreak if page.is_under("Where the truth comes from") => words.push(' '),
                Event::SoftBreak => page.faults.push(format!(
                    "a line runs on into another block: {:?}",
                    &text[range.start.saturating_sub(0)..text.len().min(range.end + 40)]
                        .lines()
                        .nth(1)
                )),
                _ => {}
            }
        }
        page
    }

    fn row(&mut self, text: &str, range: Range<usize>, table: &Table) {
        let source = &text[range];
        let columns = table.rows.first().map_or(0, Vec::len);
        let is_header = table.rows.len() == 1;
        match cells_written(source) {
            Some(cells) if is_header || cells == columns => {}
            found => self.faults.push(format!(
                "{found:?} cells under a header of {columns}: {source}"
            )),
        }
    }

    fn table(&mut self, table: Table) {
        let empty = |name: &String| name.is_empty() || name.contains("()");
        if table.rows[0].iter().any(empty) {
            self.faults
                .push(format!("a header says nothing: {:?}", table.rows[0]));
        }
        if table.rows.len() == 1 {
            self.faults
                .push(format!("a table without rows: {:?}", table.rows[0]));
        }
        self.blocks.push(Block::Table(table));
    }

    fn paragraph(&mut self, source: &str) {
        if source.starts_with('|') {
            self.faults.push(format!("a table that is none: {source}"));
        }
    }

    /// Pictures whose width is given stand as HTML.
    fn html(&mut self, tag: &str) {
        let rest = tag.split_once("src=\"").map(|(_, rest)| rest);
        let source = rest.and_then(|rest| rest.split('"').next());
        if let Some(source) = source {
            self.targets.push(source.to_owned());
            self.pictures.push(source.to_owned());
        }
    }

    /// The blocks from the heading that starts so up to the next one.
    fn under(&self, heading: &str) -> impl Iterator<Item = &Block> {
        let is_there =
            move |block: &&Block| matches!(block, Block::Heading(h) if h.starts_with(heading));
        let after = self.blocks.iter().skip_while(move |b| !is_there(b)).skip(1);
        after.take_while(|block| !matches!(block, Block::Heading(_)))
    }

    /// Whether the latest heading is that one.
    fn is_under(&self, heading: &str) -> bool {
        let headings = self.blocks.iter().rev().filter_map(|block| match block {
            Block::Heading(words) => Some(words),
            Block::List(_) | Block::Table(_) => None,
        });
        headings.take(1).any(|words| words == heading)
    }

    /// The first column of the first table there, without its header.
    fn first_column(&self, heading: &str) -> Vec<String> {
        let tables = self.under(heading).filter_map(|block| match block {
            Block::Table(table) => Some(table),
            Block::Heading(_) | Block::List(_) => None,
        });
        let rows = tables.take(1).flat_map(|table| table.rows.iter().skip(1));
        rows.map(|row| row[0].clone()).collect()
    }

    /// The items of each list there.
    fn lists(&self, heading: &str) -> Vec<usize> {
        let lists = self.under(heading).filter_map(|block| match block {
            Block::List(items) => Some(*items),
            Block::Heading(_) | Block::Table(_) => None,
        });
        lists.collect()
    }
}

/// Reads a page; nothing about it as Markdown is wrong, and what it points at exists.
fn sound(path: &Path) -> Page {
    let text = fs::read_to_string(path).unwrap();
    let page = Page::parse(&text);
    let shown = path.display();
    assert!(page.faults.is_empty(), "{shown}: {:#?}", page.faults);
    for target in page.targets.iter().filter(|to| !to.starts_with("http")) {
        let (file, place) = target.split_once('#').unwrap_or((target, ""));
        let file = match file {
            "" => path.to_owned(),
            file => path.parent().unwrap().join(file),
        };
        assert!(file.exists(), "{shown}: {target}");
        let anchor = format!("<a id=\"{place}\"></a>");
        let is_there = || fs::read_to_string(&file).unwrap().contains(&anchor);
        assert!(place.is_empty() || is_there(), "{shown}: {target}");
    }
    page
}

fn json(path: PathBuf) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn array<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map_or(&[], Vec::as_slice)
}

fn names(rows: &[Value], key: &str) -> Vec<String> {
    let name = |row: &Value| row[key].as_str().unwrap().to_owned();
    rows.iter().map(name).collect()
}

/// The pictures in a folder.
fn pictures(folder: &Path) -> BTreeSet<String> {
    let files = fs::read_dir(folder).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".png")).collect()
}

fn case_page(folder: &Path) {
    let page = sound(&folder.join("README.md"));
    let data = json(folder.join("summary.json"));
    let shown = folder.display();
    let voices = array(&data, "voices");
    assert_eq!(
        page.first_column("Each voice"),
        names(voices, "voice"),
        "{shown}"
    );
    let pairs: Vec<_> = array(&data, "pairs")
        .iter()
        .map(|pair| {
            let name = |key: &str| pair[key].as_str().unwrap().to_owned();
            format!("{} – {}", name("engine_a"), name("engine_b"))
        })
        .collect();
    assert_eq!(page.first_column("Each pair"), pairs, "{shown}");
    let engines = voices.iter().filter(|voice| !voice["engine"].is_null());
    assert_eq!(page.lists("Settings"), [engines.count()], "{shown}");
    let verdicts = array(&data, "verdicts").len();
    let found = page.lists("What was found");
    if verdicts == 0 {
        assert_eq!(found.len(), 1, "{shown}");
    } else {
        let reference = data["reference"].as_str().unwrap();
        let against_truth = [
            format!("{reference} – truth"),
            format!("truth – {reference}"),
        ];
        let known = pairs.iter().filter(|pair| against_truth.contains(pair));
        assert_eq!(found[1..], [verdicts + known.count()], "{shown}");
    }
    let own = page.pictures.iter().filter(|name| !name.contains('/'));
    let own: BTreeSet<_> = own.cloned().collect();
    assert_eq!(own, pictures(folder), "{shown}");
}

fn index(folder: &Path, studies: usize) {
    let page = sound(&folder.join("README.md"));
    let data = json(folder.join("summary.json"));
    let cases = array(&data, "cases");
    assert_eq!(page.first_column("All cases"), names(cases, "scene"));
    let judged = cases.iter().filter(|case| !case["reference"].is_null());
    let judged: Vec<_> = judged.cloned().collect();
    assert_eq!(
        page.first_column("Error against the reference"),
        names(&judged, "scene")
    );
    assert_eq!(page.lists("Engines"), [array(&data, "engines").len()]);
    assert_eq!(page.lists("Studies"), [studies]);
    let is_case = |block: &&Block| match block {
        Block::Heading(heading) => cases.iter().any(|case| case["title"] == heading.as_str()),
        Block::List(_) | Block::Table(_) => false,
    };
    if cfg!(feature = "plots") {
        assert_eq!(page.blocks.iter().filter(is_case).count(), cases.len());
    }
}

fn cost_page(folder: &Path) {
    let page = sound(&folder.join("README.md"));
    let data = json(folder.join("summary.json"));
    let scenes = array(&data, "scenes");
    assert_eq!(page.lists("What accuracy costs in time"), [scenes.len()]);
    let offers = array(&array(&scenes[0], "tags")[0], "offers");
    assert_eq!(page.first_column("The price tag"), names(offers, "engine"));
    let own: BTreeSet<_> = page.pictures.iter().cloned().collect();
    assert_eq!(own, pictures(folder));
}

fn stability_page(folder: &Path) {
    let page = sound(&folder.join("README.md"));
    let data = json(folder.join("summary.json"));
    let engines = names(array(&data, "scores"), "engine");
    assert_eq!(page.first_column("How each engine did"), engines);
    let cases = page.first_column("Every case").len() as u64;
    assert_eq!(Some(cases), data["cases"].as_u64());
    let own: BTreeSet<_> = page.pictures.iter().cloned().collect();
    assert_eq!(own, pictures(folder));
}

/// Cases of every kind: shots, clusters, springs, one that `exact` refuses, one without impacts.
const CASES: [&str; 6] = [
    "shot-2-96",
    "cluster-8",
    "spring-under",
    "corner-drop",
    "kepler-circle",
    "headon-equal",
];

/// Lists once ran together on one line, and headers said `all ()`.
#[test]
fn a_report_with_its_studies_reads_as_its_data() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let quick = ["--engine", "lecture,exact-fast", "--quiet", "--budget"];
    let [one, two] = ["headon-equal", "shot-2-96"];
    let cost = ["cost", one, two, "--repetitions", "1", "--out", "r/cost"];
    carom(folder, &[&cost[..], &quick, &["20000"]].concat());
    let hard = ["stability", "pi-1", "spring-tame", "fall-contact"];
    let to = ["--out", "r/stability"];
    carom(folder, &[&hard[..], &to, &quick, &["1000000"]].concat());
    carom(
        folder,
        &[&["report"], &CASES[..], &["--quiet", "--out", "r"]].concat(),
    );
    let report = folder.join("r");
    index(&report, 2);
    for case in CASES {
        case_page(&report.join(case));
    }
    cost_page(&report.join("cost"));
    stability_page(&report.join("stability"));
}

/// A run of its own has a page too; its engines and bodies may be called anything.
#[test]
fn names_of_all_kinds_leave_a_page_whole() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let scene = "name = \"mine\"\ntitle = \"# a | b <b> `c` *d*\"\nduration = 1.0\n\
        sample_every = 0.25\n\
        [[bodies]]\nname = \"a|b *c* <i> `d`\"\nmass = 1.0\nradius = 0.5\n\
        position = [0.0, 0.0, 0.0]\nvelocity = [1.0, 0.0, 0.0]\n\
        [[bodies]]\nname = \"- [x](y) ()\"\nmass = 1.0\nradius = 0.5\n\
        position = [1.5, 0.0, 0.0]\nvelocity = [0.0, 0.0, 0.0]\n\
        [effects.contact]\nrestitution = 0.5\n";
    fs::write(folder.join("mine.toml"), scene).unwrap();
    let engines = "lecture,exact-fast";
    carom(
        folder,
        &[
            "run",
            "mine.toml",
            "--engine",
            engines,
            "--quiet",
            "--out",
            "d",
        ],
    );
    case_page(&folder.join("d"));
}

#[test]
fn studies_of_effects_and_of_bodies_read_as_their_data() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let short = [
        "--engine",
        "lecture",
        "--repetitions",
        "1",
        "--quiet",
        "--out",
    ];
    carom(
        folder,
        &[&["effects", "shot-2-96"], &short[..], &["effects"]].concat(),
    );
    carom(
        folder,
        &[&["cost", "--bodies", "4,10"], &short[..], &["bodies"]].concat(),
    );
    let effects = sound(&folder.join("effects/README.md"));
    let table = fs::read_to_string(folder.join("effects/effects.csv")).unwrap();
    let rows = effects.first_column("What each effect costs and changes");
    assert_eq!(rows.len(), table.lines().count() - 1);
    let bodies = sound(&folder.join("bodies/README.md"));
    let own: BTreeSet<_> = bodies.pictures.iter().cloned().collect();
    assert_eq!(own, pictures(&folder.join("bodies")));
    assert!(bodies.blocks.iter().any(|b| matches!(b, Block::Table(_))));
}

/// The parser is not blind: each fault that pages had is one.
#[test]
fn faults_of_pages_are_seen() {
    let faults = |text: &str| Page::parse(text).faults.len();
    assert_eq!(
        faults("- a\n- b\n\ntext\n\n| a | b |\n|---|---|\n| 1 | 2 |\n"),
        0
    );
    assert_eq!(faults("| a | b |\n|---|---|\n| 1 \\| 2 | 3 |\n"), 0);
    for fault in [
        "a: - b\n- c\ntext\n",
        "- a\n- b\ntext that the list swallows\n",
        "| a | all () |\n|---|---|\n| 1 | 2 |\n",
        "| a |  |\n|---|---|\n| 1 | 2 |\n",
        "| a | b |\n|---|---|\n| 1 | 2 | 3 |\n",
        "| a | b |\n|---|---|\n| 1 |\n",
        "| a | b |\n|---|---|\n| 1 | 2 |\ntext that the table swallows\n",
        "| a | b |\n|---|---|\n",
        "| a | b |\n| 1 | 2 |\n",
    ] {
        assert!(faults(fault) > 0, "{fault}");
    }
}
