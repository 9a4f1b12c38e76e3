//! Verilates the configurations of `../configurations.txt` that ask for co-simulation.
//!
//! Each becomes a static library: Verilator's class, and a shim with C linkage around it. The ports are read from the header
//! that Verilator writes. A library is kept under a name made of everything that it is made of (sources, parameters, shim,
//! Verilator's version), so that only what has changed is built again.
//!
//! `SCANOUT_NETLISTS=DIR`: a configuration with a file `DIR/NAME.v` is built from that netlist instead of its sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Verilated at the same time.
const JOBS: usize = 2;

struct Configuration {
    name: String,
    top: String,
    parameters: Vec<String>,
}

/// A port of a verilated class, as its header declares it.
struct Port {
    name: String,
    bits: u32,
}

fn main() {
    if let Err(message) = build() {
        eprintln!("{message}");
        exit(1);
    }
}

fn build() -> Result<(), String> {
    let here = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    let rtl = here.parent().ok_or("the crate has no parent folder")?;
    let out = PathBuf::from(variable("OUT_DIR")?);
    let cache = out.ancestors().nth(4).unwrap_or(&out).join("verilated");
    println!("cargo:rerun-if-changed={}", rtl.join("configurations.txt").display());
    println!("cargo:rerun-if-env-changed=SCANOUT_NETLISTS");
    println!("cargo:rerun-if-changed=build.rs");
    let netlists = std::env::var_os("SCANOUT_NETLISTS").map(PathBuf::from);
    if let Some(folder) = &netlists {
        println!("cargo:rerun-if-changed={}", folder.display());
    }
    let modules = modules(rtl)?;
    // The folder too: a new file may be what a module lacked.
    println!("cargo:rerun-if-changed={}", rtl.display());
    for path in modules.values() {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    let verilator = Verilator::find()?;
    let runtime = verilator.runtime(&cache)?;
    let configurations = configurations(rtl)?;
    let next = AtomicUsize::new(0);
    let built = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..JOBS {
            scope.spawn(|| {
                while let Some(c) = configurations.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let netlist = netlists.as_ref().map(|d| d.join(format!("{}.v", c.name)));
                    let sources = match netlist.filter(|path| path.exists()) {
                        Some(path) => Ok(vec![path]),
                        None => needed(&c.top, &modules),
                    };
                    let result = sources.and_then(|s| verilator.build(c, &s, rtl, &cache));
                    if let Ok(mut built) = built.lock() {
                        built.push(result.map(|found| (c.name.clone(), found)));
                    }
                }
            });
        }
    });
    let mut table = String::from("pub(crate) static VERILATED: &[Verilated] = &[\n");
    let mut declarations = String::from("unsafe extern \"C\" {\n");
    let built = built.into_inner().map_err(|e| e.to_string())?;
    let mut built = built.into_iter().collect::<Result<Vec<_>, _>>()?;
    built.sort_by(|a, b| a.0.cmp(&b.0));
    for (name, (library, ports)) in &built {
        link(library);
        declare(&mut declarations, &mut table, name, ports);
    }
    // After the libraries that need it.
    link(&runtime);
    println!("cargo:rustc-link-lib=dylib=stdc++");
    let text = format!("{declarations}}}\n\n{table}];\n");
    fs::write(out.join("verilated.rs"), text).map_err(|e| e.to_string())
}

fn variable(name: &str) -> Result<String, String> {
    std::env::var(name).map_err(|e| format!("{name}: {e}"))
}

fn link(library: &Path) {
    let folder = library.parent().unwrap_or(library);
    let name = library.file_stem().unwrap_or_default().to_string_lossy();
    println!("cargo:rustc-link-search=native={}", folder.display());
    println!("cargo:rustc-link-lib=static={}", name.trim_start_matches("lib"));
}

/// The Rust side of one shim.
fn declare(declarations: &mut String, table: &mut String, name: &str, ports: &[Port]) {
    let _ = writeln!(
        declarations,
        "    fn {name}_new() -> *mut c_void;\n    fn {name}_delete(model: *mut c_void);\n    \
         fn {name}_eval(model: *mut c_void);\n    \
         fn {name}_port(model: *mut c_void, index: u32) -> *mut c_void;"
    );
    let _ = writeln!(
        table,
        "    Verilated {{\n        name: \"{name}\",\n        new: {name}_new,\n        \
         delete: {name}_delete,\n        eval: {name}_eval,\n        port: {name}_port,\n        \
         ports: &["
    );
    for Port { name, bits } in ports {
        let _ = writeln!(table, "            (\"{name}\", {bits}),");
    }
    table.push_str("        ],\n    },\n");
}

/// The lines of `configurations.txt` with the letter c.
fn configurations(rtl: &Path) -> Result<Vec<Configuration>, String> {
    let path = rtl.join("configurations.txt");
    let text = read(&path)?;
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace().map(String::from);
        match (words.next(), words.next(), words.next()) {
            (None, ..) => {}
            (Some(name), ..) if name.starts_with('#') => {}
            (Some(name), Some(top), Some(checks)) => {
                if checks.contains('c') {
                    found.push(Configuration { name, top, parameters: words.collect() });
                }
            }
            _ => {
                let place = format!("{}:{}", path.display(), number + 1);
                return Err(format!("{place}: expected NAME TOP CHECKS [PARAMETER=VALUE ...]"));
            }
        }
    }
    Ok(found)
}

/// Every design file by module name.
fn modules(rtl: &Path) -> Result<BTreeMap<String, PathBuf>, String> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(rtl).map_err(|e| format!("{}: {e}", rtl.display()))? {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.extension().is_some_and(|e| e == "sv") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            found.insert(name, path);
        }
    }
    Ok(found)
}

/// The files of a module and of what it instantiates: every module whose name is a word of theirs, comments apart.
fn needed(top: &str, modules: &BTreeMap<String, PathBuf>) -> Result<Vec<PathBuf>, String> {
    let mut open = vec![top.to_string()];
    let mut seen = BTreeSet::new();
    while let Some(name) = open.pop() {
        let path = modules.get(&name).ok_or_else(|| format!("no file {name}.sv beside cosim/"))?;
        if !seen.insert(name) {
            continue;
        }
        let text = read(path)?;
        let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        for word in code.flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_')) {
            if modules.contains_key(word) && !seen.contains(word) {
                open.push(word.to_string());
            }
        }
    }
    Ok(seen.iter().map(|name| modules[name].clone()).collect())
}

/// The files that a module includes.
fn included(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.trim().strip_prefix("`include \"")?.strip_suffix('"'))
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

struct Verilator {
    program: String,
    version: String,
    include: PathBuf,
    compiler: String,
}

impl Verilator {
    fn find() -> Result<Self, String> {
        let program = std::env::var("VERILATOR").unwrap_or_else(|_| "verilator".into());
        println!("cargo:rerun-if-env-changed=VERILATOR");
        let version = run(Command::new(&program).arg("--version")).map_err(|e| {
            format!("{e}\nCo-simulation needs Verilator 5.006 or newer: apt-get install verilator")
        })?;
        let root = run(Command::new(&program).args(["--getenv", "VERILATOR_ROOT"]))?;
        let include = Path::new(root.trim()).join("include");
        let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".into());
        Ok(Self { program, version, include, compiler })
    }

    /// Verilator's own library, which all models share.
    fn runtime(&self, cache: &Path) -> Result<PathBuf, String> {
        let text = self.include.join("verilated.cpp");
        let key = hash(&[self.version.as_bytes(), self.compiler.as_bytes()]);
        let folder = cache.join(format!("runtime-{key:016x}"));
        let library = folder.join("libverilated_runtime.a");
        if !library.exists() {
            fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
            let threads = self.include.join("verilated_threads.cpp");
            let mut objects = Vec::new();
            for source in [text, threads] {
                let stem = source.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let object = folder.join(stem).with_extension("o");
                self.compile(&source, &object, &[])?;
                objects.push(object);
            }
            archive(&objects, &library)?;
        }
        Ok(library)
    }

    fn compile(&self, source: &Path, object: &Path, include: &[&Path]) -> Result<(), String> {
        let mut command = Command::new(&self.compiler);
        command.args(["-std=c++17", "-O2", "-w", "-fPIC", "-DVM_COVERAGE=0", "-DVM_SC=0"]);
        command.args(["-DVM_TRACE=0", "-DVL_TIME_CONTEXT"]).arg("-I").arg(&self.include);
        for folder in include {
            command.arg("-I").arg(folder);
        }
        command.arg("-c").arg(source).arg("-o").arg(object);
        run(&mut command).map(drop)
    }

    /// The library and the ports of one configuration.
    fn build(
        &self,
        configuration: &Configuration,
        sources: &[PathBuf],
        rtl: &Path,
        cache: &Path,
    ) -> Result<(PathBuf, Vec<Port>), String> {
        let Configuration { name, top, parameters } = configuration;
        let mut parts =
            vec![self.version.clone(), self.compiler.clone(), name.clone(), top.clone()];
        parts.push(include_str!("build.rs").into());
        parts.extend(parameters.iter().cloned());
        for path in sources {
            let text = read(path)?;
            for name in included(&text) {
                parts.push(read(&rtl.join(name))?);
            }
            parts.push(text);
        }
        let parts: Vec<&[u8]> = parts.iter().map(|p| p.as_bytes()).collect();
        let folder = cache.join(format!("{name}-{:016x}", hash(&parts)));
        let library = folder.join(format!("lib{name}.a"));
        let netlist = sources.iter().all(|path| path.extension().is_some_and(|e| e == "v"));
        if !library.exists() {
            let _ = fs::remove_dir_all(&folder);
            fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
            let mut command = Command::new(&self.program);
            command.args(["--cc", "-O3", "-Wno-fatal", "-Wno-lint", "-Wno-style", "--top-module"]);
            command.arg(top).arg("--prefix").arg(format!("V{name}")).arg("--Mdir").arg(&folder);
            // A tenth of the clocks begins with random registers instead of zeros: see `Model::new`.
            command.args(["--x-initial", "unique", "--x-assign", "unique"]);
            if !netlist {
                // A netlist's parameters were applied by synthesis.
                command.args(parameters.iter().map(|p| format!("-G{p}")));
            }
            // The tables that modules read.
            command.arg(format!("+incdir+{}", rtl.display())).args(sources);
            run(&mut command)?;
        }
        let header = folder.join(format!("V{name}.h"));
        let text = read(&header)?;
        let ports = ports(&text)?;
        if !library.exists() {
            let shim = folder.join("shim.cpp");
            fs::write(&shim, shim_text(name, &ports, &folder)?).map_err(|e| e.to_string())?;
            let object = folder.join("shim.o");
            self.compile(&shim, &object, &[&folder])?;
            archive(&[object], &library)?;
        }
        Ok((library, ports))
    }
}

/// `VL_IN8(&clk,0,0);` and its kin: name, highest bit, lowest bit.
fn ports(header: &str) -> Result<Vec<Port>, String> {
    let mut ports = Vec::new();
    for line in header.lines().map(str::trim) {
        if !(line.starts_with("VL_IN") || line.starts_with("VL_OUT")) {
            continue;
        }
        let inner = line.split_once('(').and_then(|(_, rest)| rest.split_once(')'));
        let words: Vec<&str> = inner.map_or(vec![], |(inner, _)| inner.split(',').collect());
        let bad = || format!("Verilator's header has an unknown port: {line}");
        let [name, high, low, ..] = words[..] else { return Err(bad()) };
        let bit = |word: &str| word.trim().parse::<u32>().map_err(|_| bad());
        let bits = bit(high)? - bit(low)? + 1;
        ports.push(Port { name: name.trim_start_matches('&').into(), bits });
    }
    Ok(ports)
}

/// The shim: everything that Verilator wrote in one translation unit, and four functions.
fn shim_text(name: &str, ports: &[Port], folder: &Path) -> Result<String, String> {
    let mut sources = Vec::new();
    for entry in fs::read_dir(folder).map_err(|e| e.to_string())? {
        let file = entry.map_err(|e| e.to_string())?.file_name().to_string_lossy().into_owned();
        if file.ends_with(".cpp") && file != "shim.cpp" {
            sources.push(file);
        }
    }
    sources.sort();
    let mut text = String::from("#ifndef VL_TIME_STAMP64\n#endif\n");
    for file in sources {
        let _ = writeln!(text, "#include \"{file}\"");
    }
    let _ = writeln!(
        text,
        "\nextern \"C\" {{\n\
         void* {name}_new() {{\n    Verilated::randReset(2);\n    return new V{name};\n}}\n\
         void {name}_delete(void* model) {{ delete static_cast<V{name}*>(model); }}\n\
         void {name}_eval(void* model) {{ static_cast<V{name}*>(model)->eval(); }}\n\
         void* {name}_port(void* model, unsigned index) {{\n    \
         V{name}* m = static_cast<V{name}*>(model);\n    switch (index) {{"
    );
    for (index, Port { name, .. }) in ports.iter().enumerate() {
        let _ = writeln!(text, "        case {index}: return &m->{name};");
    }
    text.push_str("    }\n    return nullptr;\n}\n}\n");
    Ok(text)
}

fn archive(objects: &[PathBuf], library: &Path) -> Result<(), String> {
    let program = std::env::var("AR").unwrap_or_else(|_| "ar".into());
    run(Command::new(program).arg("crs").arg(library).args(objects)).map(drop)
}

/// Runs a program to its end; its standard output, or all of what it said.
fn run(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|e| format!("{:?}: {e}", command.get_program()))?;
    let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(stdout);
    }
    Err(format!("{command:?}\n{stdout}{}", String::from_utf8_lossy(&output.stderr)))
}

/// FNV-1a over the parts and their lengths.
fn hash(parts: &[&[u8]]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for part in parts {
        for byte in part.iter().copied().chain((part.len() as u64).to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    hash
}
