//! The law of the house: a room imports only from the rooms that `docs/architecture.md` lists for
//! it, and no files import each other in a circle.
//!
//! Read from the text of `src`: every `use` and every path that begins with `crate::`, `super::` or
//! `self::`, tests left out. A name that a `mod.rs` only hands on counts as imported from the file
//! that defines it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A module's path from the crate's root, as `filter/ewa`; the root is empty.
type Module = String;

/// The modules of `src`, each with its text: no comments, no tests.
struct House {
    texts: BTreeMap<Module, String>,
}

impl House {
    fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut house = Self { texts: BTreeMap::new() };
        house.read_folder(&root, "");
        house
    }

    fn read_folder(&mut self, folder: &Path, module: &str) {
        for entry in fs::read_dir(folder)
            .expect("a folder of src")
            .map(|entry| entry.expect("an entry").path())
        {
            let name = entry.file_stem().expect("a name").to_string_lossy().into_owned();
            let inner = join(module, &name);
            if entry.is_dir() {
                self.read_folder(&entry, &inner);
            } else if entry.extension().is_some_and(|extension| extension == "rs") {
                let is_own = name == "mod" || name == "lib";
                let text = fs::read_to_string(&entry).expect("a source file");
                self.texts.insert(if is_own { module.into() } else { inner }, code_of(&text));
            }
        }
    }

    /// The modules that a module imports from, each with the path that says so.
    fn imports(&self, module: &str) -> BTreeMap<Module, String> {
        let paths = paths(&self.texts[module]);
        let mut imports = BTreeMap::new();
        for path in &paths {
            if let Some(target) = self.resolve(module, path, 0).filter(|target| target != module) {
                imports.insert(target, path.join("::"));
            }
        }
        imports
    }

    /// The module that defines what a path in `module` names; `None` for what other crates define.
    fn resolve(&self, module: &str, path: &[String], depth: usize) -> Option<Module> {
        let (mut at, mut rest) = match path.first()?.as_str() {
            "crate" => (String::new(), &path[1..]),
            "self" => (module.into(), &path[1..]),
            "super" => (parent(module), &path[1..]),
            child if self.texts.contains_key(&join(module, child)) => (module.into(), path),
            _ => return None,
        };
        while let Some(name) = rest.first() {
            let inner = join(&at, name);
            if name == "super" {
                at = parent(&at);
            } else if self.texts.contains_key(&inner) {
                at = inner;
            } else if depth < 8 {
                // Not a module: an item, which may be handed on from elsewhere.
                let handed_on =
                    paths(&self.texts[&at]).into_iter().filter(|path| path.last() == Some(name));
                let origin = handed_on
                    .filter(|path| path.len() > 1)
                    .find_map(|path| self.resolve(&at, &path, depth + 1));
                return Some(origin.unwrap_or(at));
            } else {
                return Some(at);
            }
            rest = &rest[1..];
        }
        Some(at)
    }
}

fn join(module: &str, name: &str) -> Module {
    if module.is_empty() { name.into() } else { format!("{module}/{name}") }
}

fn parent(module: &str) -> Module {
    module.rsplit_once('/').map_or(String::new(), |(parent, _)| parent.into())
}

/// The room that a module lies in.
fn room(module: &str) -> &str {
    module.split('/').next().unwrap_or("")
}

/// A file without comments, without the tests at its end, and without who may see what.
fn code_of(text: &str) -> String {
    let code = text.split("#[cfg(test)]").next().unwrap_or("");
    let code = code
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<Vec<_>>()
        .join("\n");
    let mut parts = code.split("pub(in ");
    let first = parts.next().unwrap_or("").to_string();
    parts.fold(first, |code, part| code + "pub" + part.split_once(')').map_or("", |(_, rest)| rest))
}

/// Every path that a `use` brings in, and every other one that begins at the crate, the parent or
/// the module itself.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for statement in code.split(';') {
        let statement = statement.trim();
        // What stands before a `use` within a statement are attributes and visibility.
        let tree = statement.rsplit_once("use ").filter(|(before, _)| {
            let before = before.rsplit(['{', '}', ']']).next().unwrap_or("").trim();
            before.is_empty() || before.starts_with("pub")
        });
        match tree {
            Some((_, tree)) => expand(tree.trim(), &[], &mut paths),
            None => paths.extend(inline_paths(statement)),
        }
    }
    paths
}

/// The leaves of a `use` tree.
fn expand(tree: &str, before: &[String], paths: &mut Vec<Vec<String>>) {
    let head = tree.find('{').map_or(tree, |brace| &tree[..brace]);
    let mut path = before.to_vec();
    let name = head.split(" as ").next().unwrap_or("").trim();
    path.extend(
        name.split("::")
            .map(str::trim)
            .filter(|name| !name.is_empty() && *name != "self")
            .map(String::from),
    );
    if name.starts_with("self::") {
        path.insert(0, "self".into());
    }
    let Some(brace) = tree.find('{') else { return paths.push(path) };
    let inner = &tree[brace + 1..tree.rfind('}').expect("a closing brace")];
    let (mut depth, mut start) = (0, 0);
    for (i, c) in inner.char_indices().chain([(inner.len(), ',')]) {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            let leaf = inner[start..i].trim();
            if !leaf.is_empty() {
                expand(leaf, &path, paths);
            }
            start = i + 1;
        }
    }
}

fn inline_paths(code: &str) -> Vec<Vec<String>> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let words = code
        .split(|c| !is_name(c))
        .filter(|word| ["crate::", "super::", "self::"].iter().any(|s| word.starts_with(s)));
    words
        .map(|word| word.split("::").filter(|name| !name.is_empty()).map(String::from).collect())
        .collect()
}

/// The rooms that each room may import from, by the table of `docs/architecture.md`.
fn law() -> BTreeMap<String, BTreeSet<String>> {
    let text =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md"))
            .expect("the page");
    let rows = text.lines().skip_while(|line| !line.starts_with("| room | may import |")).skip(2);
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        let rooms = cells[2].split_whitespace().map(|room| room.trim_matches('`').to_string());
        (cells[1].trim_matches('`').into(), rooms.filter(|room| room != "-").collect())
    })
    .collect()
}

#[test]
fn rooms_import_only_what_the_law_lists() {
    let (house, law) = (House::read(), law());
    let rooms: BTreeSet<_> =
        house.texts.keys().map(|module| room(module)).filter(|room| !room.is_empty()).collect();
    let listed: BTreeSet<_> = law.keys().map(String::as_str).collect();
    assert_eq!(rooms, listed, "the rooms of src and those of the table");
    let mut broken = Vec::new();
    for module in house.texts.keys().filter(|module| !module.is_empty()) {
        for (target, path) in house.imports(module) {
            let (from, to) = (room(module), room(&target));
            // Of the root are the names that it hands on: they count where they are defined.
            if from != to && !to.is_empty() && !law[from].contains(to) {
                broken.push(format!("{module} imports {path}: `{from}` may not see `{to}`"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn the_law_has_no_way_back() {
    let law = law();
    let to: BTreeMap<_, _> =
        law.iter().map(|(room, may)| (room.clone(), may.iter().cloned().collect())).collect();
    assert_eq!(circle(&to), None);
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let house = House::read();
    let files = house.texts.keys().filter(|module| !module.is_empty());
    let imports = files.map(|module| (module.clone(), house.imports(module).into_keys().collect()));
    assert_eq!(circle(&imports.collect()), None);
}

/// A way from a node back to itself, if there is one.
fn circle(to: &BTreeMap<String, Vec<String>>) -> Option<Vec<String>> {
    fn walk(
        at: &str,
        to: &BTreeMap<String, Vec<String>>,
        way: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> bool {
        if let Some(start) = way.iter().position(|node| node == at) {
            way.drain(..start);
            return true;
        }
        if done.contains(at) {
            return false;
        }
        way.push(at.into());
        if to.get(at).into_iter().flatten().any(|next| walk(next, to, way, done)) {
            return true;
        }
        way.pop();
        done.insert(at.into());
        false
    }
    let (mut way, mut done) = (Vec::new(), BTreeSet::new());
    to.keys().any(|node| walk(node, to, &mut way, &mut done)).then_some(way)
}

#[test]
fn paths_are_read_from_the_text() {
    let code = "pub use crate::a::{b::C, self, d::{E, F as G}};\n#[inline]\npub(super) fn f() { super::h::i(); x::y }";
    let found: Vec<_> = paths(code).into_iter().map(|path| path.join("::")).collect();
    assert_eq!(
        found,
        ["crate::a::b::C", "crate::a", "crate::a::d::E", "crate::a::d::F", "super::h::i"]
    );
}

#[test]
fn circles_are_found() {
    let to = |arrows: &[(&str, &str)]| {
        let mut to = BTreeMap::<String, Vec<String>>::new();
        arrows.iter().for_each(|(a, b)| to.entry(a.to_string()).or_default().push(b.to_string()));
        to
    };
    assert_eq!(circle(&to(&[("a", "b"), ("b", "c"), ("a", "c")])), None);
    assert_eq!(
        circle(&to(&[("a", "b"), ("b", "c"), ("c", "b")])),
        Some(vec!["b".into(), "c".into()])
    );
}
