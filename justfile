# Short names for the commands of README.md and CONTRIBUTING.md.

# List them
default:
    @just --list

# All tests
test:
    cargo test --workspace

# Formatting and lints, warnings denied
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets --locked -- -D warnings

# Workflow files and shell scripts (needs npm)
lint-workflows:
    packaging/lint-workflows

# Licences and advisories of the dependencies (needs cargo-deny)
deny:
    cargo deny check

# What must pass before a change goes in
ci:
    .ci/run

# What README.md says of Python, in a fresh virtual environment, and the package's tests
test-python:
    .ci/python

# The explorer's page in a browser, with screenshots: just test-explore target/explore
test-explore *folder:
    .ci/explore {{folder}}

# The explorer with its engine in WebAssembly, for any static host and as one file: just web [FOLDER]
web *folder:
    packaging/web {{folder}}

# What `just web` needs beside a Rust toolchain and Python
web-target:
    rustup target add wasm32-wasip1

# Everything in the paper, into reproduction/
reproduce *options:
    cargo run --release -- reproduce {{options}}

# Reference numbers by a second program (needs Python; about three minutes)
reference:
    python3 -m venv target/reference
    target/reference/bin/pip install --quiet -r bench/reference/requirements.txt
    cd bench/reference && ../../target/reference/bin/python run.py && ../../target/reference/bin/python check.py

# Random harsh chains by the program and by an independent integration: just test-random 1000
test-random *options:
    cargo build --release --locked -p hertzchain -p hertzchain-random
    target/release/hertzchain-random {{options}}

# Coverage-guided fuzzing of a reader (needs cargo-fuzz): just fuzz records 3600
fuzz target seconds="60":
    bench/fuzz/run {{target}} {{seconds}}

# Coverage of the stated errors of picked pulses: just bench-picking 20 --seed 7
bench-picking *options:
    cargo run --release --locked -p hertzchain-picking -- {{options}}

# Coverage of fits, with nuisance parameters and joint: just bench-coverage 500 50 joint-delay
bench-coverage *options:
    cargo run --release --locked -p hertzchain-infer --example coverage -- {{options}}

# The same shots by general integrators and LAMMPS, side by side (needs Python; about ten minutes)
bench-peers *options:
    bench/peers/run.sh {{options}}

# Lints and a small instance of that comparison
test-peers:
    cargo fmt --manifest-path bench/peers/Cargo.toml --check
    cargo clippy --manifest-path bench/peers/Cargo.toml --all-targets --locked -- -D warnings
    cargo test --manifest-path bench/peers/Cargo.toml --locked

# Documentation of all crates
doc:
    cargo doc --workspace --no-deps --open

# The site, into target/docs/html: just docs [WHEEL]
docs *wheel:
    docs/build {{wheel}}

# Every code block of README.md and the pages, executed (after `just docs` and a release build)
tutorials *options:
    cargo build --release --locked -p hertzchain
    target/docs/venv/bin/python docs/run_blocks.py {{options}}

# Wheels of the stable ABI and the source distribution, into target/wheels
wheels:
    packaging/wheels

# A Debian package, into target/
deb:
    cargo build --release --locked -p hertzchain
    packaging/deb target/release/hertzchain target

# What a release consists of, checked, tagged and collected: just release 0.2.0
release version:
    packaging/release {{version}}
