//! Compiles the shims over the two physics engines, a planner and, for `make bench`, a tree of points. They are optimised in
//! every profile, since they dominate the run time.

fn main() {
    let mut missing = Vec::new();
    let mut shims = vec![
        ("judge/bullet", "bullet", "3.0", "libbullet-dev"),
        ("judge/ode", "ode", "0.16", "libode-dev"),
        ("reach/ompl", "ompl", "1.5", "libompl-dev"),
    ];
    if std::env::var_os("CARGO_FEATURE_PEERS").is_some() {
        shims.push(("performance/nanoflann", "nanoflann", "1.4", "libnanoflann-dev"));
    }
    for (source, library, minimum, package) in shims {
        // `compile` links the libraries, after the shims that need them.
        match pkg_config::Config::new().atleast_version(minimum).cargo_metadata(false).probe(library) {
            Ok(found) => compile(source, &found),
            Err(error) => missing.push((package, error)),
        }
    }
    if !missing.is_empty() {
        for (package, error) in &missing {
            eprintln!("{package}: {error}");
        }
        let packages: Vec<_> = missing.iter().map(|(package, _)| *package).collect();
        eprintln!(
            "host-tests needs Debian's {} and pkg-config: `make setup` installs them, and `scripts/setup.sh bench` those of the feature peers",
            packages.join(", ")
        );
        std::process::exit(1);
    }
    println!("cargo::rerun-if-changed=src/judge/engine.h");
    println!("cargo::rerun-if-changed=build.rs");
}

fn compile(source: &str, found: &pkg_config::Library) {
    let name = format!("hangpose_{}", source.replace('/', "_"));
    let source = format!("src/{source}.cpp");
    println!("cargo::rerun-if-changed={source}");
    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").opt_level(2).warnings(true).file(&source);
    for path in &found.include_paths {
        // As system headers, after those of the compiler, which suppresses their warnings.
        build.flag("-idirafter").flag(path);
    }
    // For example the precision of ODE's build.
    for (name, value) in &found.defines {
        build.define(name, value.as_deref());
    }
    build.compile(&name);
    for path in &found.link_paths {
        println!("cargo::rustc-link-search=native={}", path.display());
    }
    for name in &found.libs {
        println!("cargo::rustc-link-lib={name}");
    }
}
