//! Compiles the C library, and has the C compiler hold `src/layout.rs` against its own sizes and offsets.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

const PARTS: [&str; 4] = ["window", "refined", "hazard", "movers"];

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

/// C that does not compile where a size or offset is not the one of `src/layout.rs`.
fn assertions(layout: &str) -> String {
    let mut c = String::from("#include \"goe.h\"\n#ifdef GOE_RUST_FLIGHT\n#include \"goe_flight.h\"\n#endif\n");
    let mut name = String::new();
    let mut inside = false;
    for line in layout.lines().map(str::trim) {
        match line {
            "layout! {" | "layout_flight! {" => {
                inside = true;
                c += if line.contains("flight") {
                    "#ifdef GOE_RUST_FLIGHT\n"
                } else {
                    "#if 1\n"
                };
            }
            "}" if inside && name.is_empty() => {
                inside = false;
                c += "#endif\n";
            }
            "}" => name.clear(),
            _ if inside && !line.is_empty() && !line.starts_with("//") => {
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
            _ => {}
        }
    }
    c
}

/// Bytes of the estimator with these parts. The C compiler says so if they are others.
fn estimator_bytes() -> usize {
    match (has("window"), has("refined"), has("movers")) {
        (_, false, _) => 928,
        (true, true, false) => 2328,
        (false, true, false) => 1976,
        (true, true, true) => 2904,
        (false, true, true) => 2552,
    }
}

fn main() {
    assert!(
        has("window") || has("refined"),
        "goe: one of the features `window` and `refined` is needed"
    );
    let (lib, flight) = folders();
    for path in [&lib, &flight, Path::new("src")] {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let layout = fs::read_to_string("src/layout.rs").expect("src/layout.rs");
    let mut c = assertions(&layout);
    let bytes = estimator_bytes();
    let constant =
        format!("/// Bytes of an estimator, which depend on the parts.\npub const ESTIMATOR_BYTES: usize = {bytes};\n");
    fs::write(out.join("bytes.rs"), constant).expect("OUT_DIR can be written");
    let _ = writeln!(
        c,
        "GOE_STATIC_ASSERT(sizeof(goe_estimator_t) == {bytes}, size_of_goe_estimator_t);"
    );
    if has("flight") {
        let bytes = 1632 + 4 * (bytes + 128);
        let _ = writeln!(
            c,
            "GOE_STATIC_ASSERT(sizeof(goe_flight_t) == {bytes}, size_of_goe_flight_t);"
        );
    }
    let check = out.join("layout.c");
    fs::write(&check, c).expect("OUT_DIR can be written");

    let mut build = cc::Build::new();
    build
        .std("c99")
        .flag_if_supported("-ffp-contract=off") // the same bits everywhere
        .flag_if_supported("-fno-math-errno")
        .flag_if_supported("-fno-short-enums") // enumerations are int, as in ffi.rs
        .include(&lib)
        .file(check) // first: a wrong layout stops at once
        .file("src/shim.c")
        .files(sources(&lib));
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
