//! Compiles the C library, and has the C compiler hold `src/layout.rs` and the constants of `src/ffi.rs` against its own.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

const PARTS: [&str; 4] = ["window", "filter", "hazard", "target_motion"];
const FLIGHT_OWN: usize = 1864; // bytes of the flight layer without its obstacles
const SLOTS: usize = 4; // obstacles of the flight layer
const SLOT: usize = 136; // bytes of an obstacle without its estimator

// The same bits everywhere; sqrtf as an instruction; enumerations are int, as in ffi.rs.
const FLAGS: [&str; 3] = ["-ffp-contract=off", "-fno-math-errno", "-fno-short-enums"];

fn has(feature: &str) -> bool {
    env::var_os(format!("CARGO_FEATURE_{}", feature.to_uppercase())).is_some()
}

/// Folders of the library and of the flight layer: in the packed crate, or in the project's tree.
fn folders() -> (PathBuf, PathBuf) {
    let packed = Path::new("csrc");
    if packed.is_dir() {
        return (packed.join("lib"), packed.join("flight"));
    }
    (PathBuf::from("../../lib"), PathBuf::from("../flight"))
}

/// All .c files below a folder, sorted.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for path in entries.map(|entry| entry.expect("a folder's entry").path()) {
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "c") {
            found.push(path);
        }
    }
    found.sort();
    found
}

const CHECKED: &str = "#include \"goe.h\"\n#ifdef GOE_RUST_FLIGHT\n#include \"goe_flight.h\"\n#endif\n";

/// The condition of a list of `src/layout.rs`, for C's preprocessor.
fn condition(line: &str) -> Option<&'static str> {
    match line {
        "layout! {" => Some("1"),
        "layout_hazard! {" => Some("GOE_WITH_HAZARD"),
        "layout_flight! {" => Some("defined GOE_RUST_FLIGHT"),
        "layout_flight_32! {" => Some("defined GOE_RUST_FLIGHT && UINTPTR_MAX == 0xFFFFFFFF"),
        "layout_flight_64! {" => Some("defined GOE_RUST_FLIGHT && UINTPTR_MAX > 0xFFFFFFFF"),
        _ => None,
    }
}

/// C that does not compile where a size or offset is not the one of `src/layout.rs`.
fn layout_assertions(layout: &str) -> String {
    let mut c = String::new();
    let mut name = String::new();
    let mut inside = false;
    for line in layout.lines().map(str::trim) {
        if let Some(condition) = condition(line) {
            inside = true;
            let _ = writeln!(c, "#if {condition}");
        } else if line == "}" && inside && name.is_empty() {
            inside = false;
            c += "#endif\n";
        } else if line == "}" {
            name.clear();
        } else if inside && !line.is_empty() && !line.starts_with("//") {
            let (field, number) = line
                .trim_end_matches(['{', ',', ' '])
                .split_once(": ")
                .expect("name: number");
            if line.ends_with('{') {
                name = field.to_string();
                let _ = writeln!(c, "GOE_STATIC_ASSERT(sizeof({name}) == {number}, size_of_{name});");
            } else {
                let c_field = field.trim_end_matches('_');
                let _ = writeln!(
                    c,
                    "GOE_STATIC_ASSERT(offsetof({name}, {c_field}) == {number}, {name}_{field});"
                );
            }
        }
    }
    c
}

/// C that does not compile where a constant is not the one of `src/ffi.rs`.
fn constant_assertions(ffi: &str) -> String {
    let mut c = String::new();
    let mut count = 0;
    for list in ffi
        .split("\n")
        .map(str::trim)
        .collect::<Vec<_>>()
        .split(|&line| line == "}")
    {
        let Some(start) = list.iter().position(|&line| line == "constants! {") else {
            continue;
        };
        for constant in list[start + 1..].join(" ").split([',', ';']) {
            let Some((name, value)) = constant.split_once(" = ") else {
                continue;
            };
            let name = name.rsplit(' ').next().expect("a name");
            let part = if name.starts_with("GOE_FLIGHT_") {
                "defined GOE_RUST_FLIGHT"
            } else if name.starts_with("GOE_DECISION_") {
                "GOE_WITH_HAZARD"
            } else {
                "1"
            };
            let _ = writeln!(
                c,
                "#if {part}\nGOE_STATIC_ASSERT({name} == {value}, constant_{name});\n#endif"
            );
            count += 1;
        }
    }
    assert!(count > 50, "src/ffi.rs: its constants are not found");
    c
}

/// Bytes of the estimator with these parts. The C compiler says so if they are others.
fn estimator_bytes() -> usize {
    match (has("window"), has("filter"), has("target_motion")) {
        (_, false, _) => 944,
        (true, true, false) => 1752,
        (false, true, false) => 1400,
        (true, true, true) => 2096,
        (false, true, true) => 1744,
    }
}

fn main() {
    assert!(
        has("window") || has("filter"),
        "goe: one of the features `window` and `filter` is needed"
    );
    let (lib, flight) = folders();
    for path in [&lib, &flight, Path::new("src")] {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let read = |name: &str| fs::read_to_string(name).unwrap_or_else(|error| panic!("{name}: {error}"));
    let estimator = estimator_bytes();
    let mut bytes = format!(
        "/// Bytes of an estimator, which depend on the parts.\npub const ESTIMATOR_BYTES: usize = {estimator};\n"
    );
    let mut c = CHECKED.to_string() + &layout_assertions(&read("src/layout.rs"));
    c += &constant_assertions(&read("src/ffi.rs"));
    let _ = writeln!(
        c,
        "GOE_STATIC_ASSERT(sizeof(goe_estimator_t) == {estimator}, size_of_goe_estimator_t);"
    );
    if has("flight") {
        let flight = FLIGHT_OWN + SLOTS * (estimator + SLOT);
        let _ = writeln!(
            bytes,
            "/// Bytes of the flight layer's memory.\npub const FLIGHT_BYTES: usize = {flight};"
        );
        let _ = writeln!(
            c,
            "GOE_STATIC_ASSERT(sizeof(goe_flight_t) == {flight}, size_of_goe_flight_t);"
        );
    }
    fs::write(out.join("bytes.rs"), bytes).expect("OUT_DIR can be written");
    let check = out.join("layout.c");
    fs::write(&check, c).expect("OUT_DIR can be written");

    let mut build = cc::Build::new();
    build
        .std("c99")
        .include(&lib)
        .file(check) // first: a wrong layout stops at once
        .file("src/shim.c")
        .files(sources(&lib));
    let compiler = build.get_compiler();
    for flag in FLAGS {
        if compiler.is_like_gnu() || compiler.is_like_clang() {
            build.flag(flag); // refused loudly, not left out
        } else {
            build.flag_if_supported(flag);
        }
    }
    for part in PARTS {
        let value = if has(part) { "1" } else { "0" };
        build.define(&format!("GOE_WITH_{}", part.to_uppercase()), value);
    }
    if has("flight") {
        build
            .define("GOE_RUST_FLIGHT", None)
            .include(&flight)
            .files(sources(&flight));
    }
    build.compile("goe");
    if env::var("CARGO_CFG_UNIX").is_ok() {
        println!("cargo:rustc-link-lib=m");
    }
}
