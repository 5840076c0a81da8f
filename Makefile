.DEFAULT_GOAL := help
.PHONY: help setup demo picture test test_rust test_c embedded fuzz trust book bench profile tables meant reach calibrate peer lib \
	command build_command install deb dist abi samples header clean

help:
	@echo "make demo     predict how the sample mug hangs on the sample hook, plan a path, simulate it and draw it"
	@echo "make picture  make the pictures of the README anew: docs/demo.png and docs/hang.gif"
	@echo "make book     build the book in build/book and check all that it says"
	@echo "make test     run all checks and tests"
	@echo "make fuzz     run the fuzz targets, T seconds in all: [T=60]"
	@echo "make bench    measure time and memory, also of other libraries, and write docs/PERFORMANCE.md [PEER=peer.py] [MESHES=folder]"
	@echo "make profile  show where the time goes: build/profile.svg and build/profile.txt"
	@echo "make peer     compare poses with another implementation: PEER=peer.py MESHES=folder"
	@echo "make tables   simulate 600 pairs in two engines and write docs/RESULTS.md [MESHES=folder adds real meshes]"
	@echo "make meant    measure kinds, turned frames, mug trees, tolerances and probabilities [MESHES=folder adds real meshes]"
	@echo "make reach    plan paths in several scenes, replay them in Bullet and write two sections of docs/RESULTS.md"
	@echo "make calibrate  refit the constants of docs/PROBABILITY.md [MESHES=folder]"
	@echo "make lib      build libhangpose.a and libhangpose.so for C and C++ in build/link"
	@echo "make command  build the command hangpose, its completions for shells and its man pages"
	@echo "make install  install the libraries, the headers and the command: [PREFIX=/usr/local] [DESTDIR=...]"
	@echo "make deb      build the Debian packages libhangpose3, libhangpose-dev and hangpose in build/"
	@echo "make dist     build a release in build/dist/: archives for x86-64 and aarch64, packages, checksums"
	@echo "make embedded run the C library on a Cortex-M7 and on aarch64 under qemu: with the bits of a desktop"
	@echo "make trust    run the long checks of docs/TRUST.md: the same bits everywhere, cancels, sanitizers, the supply chain, fuzzing"
	@echo "make abi      store the binary interface of this version in ffi/abi/"
	@echo "make samples  regenerate samples/"
	@echo "make header   regenerate include/hangpose.h from ffi/"
	@echo "make setup    install missing tools"
	@echo "make clean    remove build products"

setup:
	@scripts/setup.sh

demo: setup
	@mkdir -p build
	cargo run --release -p hangpose -- predict --object samples/mug.obj --supporter samples/hook.ply \
		--plan --start samples/mug_start.json --json build/demo.json
	@echo "The poses and the path are in build/demo.json. Simulation in Bullet:"
	cargo run --release -p host-tests --bin drop -- --object samples/mug.obj --supporter samples/hook.obj --poses build/demo.json --picture build/demo.png

picture: demo
	cargo run --release -p host-tests --bin drop -- --object samples/mug.obj --supporter samples/hook.obj --poses build/demo.json \
		--picture docs/demo.png --film docs/hang.gif

# Two lanes for two processors. The book comes last: its commands are those of the lanes, and its Python the module.
test: setup
	$(MAKE) --no-print-directory --jobs=2 --output-sync=target test_rust test_c
	scripts/python.sh
	scripts/book.sh

test_rust:
	python3 -m unittest discover --start-directory bench
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
	$(target_dir)/debug/examples/samples --check
	$(target_dir)/debug/examples/header --check

test_c:
	embedded/test.sh
	embedded/no_panic.sh
	embedded/stack.sh
	scripts/link.sh
	scripts/colcon.sh
	scripts/packages.sh
	scripts/viewer.sh
	scripts/slurm_test.sh

embedded: setup
	embedded/test.sh

T ?= 60

fuzz:
	@scripts/setup.sh fuzz
	scripts/fuzz.sh $(T)

# What takes longer than a test may.
trust: embedded
	@scripts/setup.sh trust
	embedded/same_bits.sh
	cargo run --release -p host-tests --bin cancel -- --limit 1
	cargo run --release -p host-tests --bin worst -- --limit 500
	scripts/sanitize.sh
	scripts/supply.sh
	scripts/reproducible.sh
	$(MAKE) --no-print-directory fuzz T=300

book: setup
	scripts/book.sh

# Open3D and MuJoCo are not to be had everywhere: what needs them is left out then.
bench:
	@scripts/setup.sh bench
	@$(MAKE) --no-print-directory $(peer_python) || echo "bench: no Open3D and MuJoCo here"
	cargo build --release -p hangpose
	cargo build --release -p host-tests --features peers --bin speed --bin reach --bin primitives
	bench/run.sh $(if $(PEER),--peer $(PEER)) $(if $(MESHES),--meshes $(MESHES)) $(if $(ONLY),--only $(ONLY))

profile:
	@scripts/setup.sh profile
	scripts/profile.sh

# Images of the object and of the supporter; s is for sensible single views.
scans = 24+3,24+1,3+1,1+1s,1+1

tables: setup
	cargo run --release -p host-tests --bin tables -- $(if $(MESHES),--meshes $(MESHES) --real-pairs 53)
	@printf '\n## Contribution of each part\n\n110 generated pairs of seed 2 and 73 that cannot hang, judged by Bullet alone:\n\n' >> docs/RESULTS.md
	cargo run --release -p host-tests --bin tables -- --summary --engine bullet --pairs 110 --seed 2 \
		--profile default,sites-only,sites-settled,contacts-only,eight-attempts --json build/parts.jsonl >> docs/RESULTS.md
	@printf '## Caps\n\nThe weakest kind, too rare among 600 pairs; from 3300 pairs of seed 202, judged by Bullet alone:\n\n' >> docs/RESULTS.md
	cargo run --release -p host-tests --bin tables -- --summary --engine bullet --profile default --only cap \
		--pairs 3300 --seed 202 --json build/caps.jsonl >> docs/RESULTS.md
	@printf '## Scans\n\nThe object as a mesh from so many depth images, the supporter as a cloud from so many more, both with noise of 0.5 mm\nand judged on the true shapes. Views are random; with an s, single ones look through an opening of the object and at the\nfront of the supporter. 90 pairs of seed 31, judged by Bullet alone:\n\n' >> docs/RESULTS.md
	cargo run --release -p host-tests --bin tables -- --summary --engine bullet --profile default --pairs 90 --seed 31 \
		--scan $(scans) --json build/scans.jsonl >> docs/RESULTS.md
	@printf '## The core against Bullet\n\nRandom candidate poses, released by `cargo run --release -p host-tests --bin settle`:\n\n```text\n' >> docs/RESULTS.md
	cargo run --release -p host-tests --bin settle >> docs/RESULTS.md
	@printf '```\n' >> docs/RESULTS.md

meant: setup
	cargo run --release -p host-tests --bin tables -- --summary --engine bullet --profile default --pairs 100 --seed 41 --json build/meant.jsonl
	cargo run --release -p host-tests --bin meant -- turned --pairs 160 --seed 41
	cargo run --release -p host-tests --bin meant -- many --pairs 15 --seed 41
	cargo run --release -p host-tests --bin meant -- tolerance --pairs 60 --seed 41
	cargo run --release -p host-tests --bin meant -- probability --pairs 200 --seed 41 $(if $(MESHES),--meshes $(MESHES))

reach: setup
	cargo run --release -p host-tests --bin reach -- --seed 65 --pairs 88 --trees 24 --enclosed 12 --peer --out docs/RESULTS.md
	cargo run --release -p host-tests --bin reach -- --seed 65 --pairs 44 --trees 0 --enclosed 0 --scene nothing,wall --gripper \
		--json build/reach_gripper.jsonl --out docs/RESULTS.md --section "Paths with a gripper"

peer_python = build/peer/bin/python

$(peer_python): bench/requirements.txt
	python3 -m venv build/peer
	$(peer_python) -m pip install --quiet --requirement bench/requirements.txt
	@touch $@

# Points of the supporter's cloud.
sparse = 30 60 120 250 500 1000 10000

calibrate: setup $(peer_python)
	@mkdir -p build/sparse
	cargo run --release -p host-tests --bin tables -- --summary --all --engine bullet --profile default --pairs 330 --seed 100 --json build/calibration.jsonl
ifdef MESHES
	cargo run --release -p host-tests --bin tables -- --summary --all --engine bullet --profile default --pairs 0 --seed 100 \
		--meshes $(MESHES) --real-pairs 106 --json build/calibration_real.jsonl
endif
	$(peer_python) bench/calibrate.py build/calibration.jsonl $(if $(MESHES),build/calibration_real.jsonl)
	cargo run --release -p host-tests --bin tables -- --summary --all --engine bullet --profile improbable --pairs 60 --seed 12 \
		--scan $(scans) --json build/doubt.jsonl
	$(peer_python) bench/doubt.py build/doubt.jsonl
	for points in $(sparse); do \
		cargo run --release -p host-tests --bin tables -- --summary --engine bullet --profile default --pairs 60 --seed 72 \
			--points $$points --json build/sparse/$$points.jsonl || exit; done
	$(peer_python) bench/sparse.py $(sparse:%=build/sparse/%.jsonl)

peer: setup $(peer_python)
	cargo build --release -p hangpose
	$(peer_python) bench/peer.py --peer $(PEER) --meshes $(MESHES)

header:
	cargo run -p hangpose-ffi --example header

PREFIX ?= /usr/local
target_dir = $(or $(CARGO_TARGET_DIR),$(CURDIR)/target)
cargo_dir = $(target_dir)/link

# Does not depend on `setup`, which installs the tools of the tests. Needs cargo, cmake and a C compiler.
lib:
	@for tool in cargo cmake cc; do command -v $$tool >/dev/null || { echo "make lib: $$tool was not found: install it" >&2; exit 1; }; done
	cmake -S . -B build/link -DCMAKE_INSTALL_PREFIX=$(PREFIX) -DHANGPOSE_CARGO_DIR=$(cargo_dir)
	cmake --build build/link

# The command with its completions and man pages. COMMAND=file takes a command that is built already.
command: $(if $(COMMAND),,build_command)
	cmake -S . -B build/link -DCMAKE_INSTALL_PREFIX=$(PREFIX) -DHANGPOSE_CARGO_DIR=$(cargo_dir) -DHANGPOSE_COMMAND=$(command_file)
	cmake --build build/link --target hangpose_command

command_file = $(abspath $(or $(COMMAND),$(target_dir)/release/hangpose))

build_command:
	cargo build --locked --release -p hangpose

# Builds only what is missing, so that another user can run it: make lib command && sudo make install.
install:
	@test -e build/link/libhangpose.a || $(MAKE) lib
	@test -e build/link/command/hangpose || $(MAKE) command
	cmake --install build/link --prefix $(PREFIX)

deb: $(if $(COMMAND),,build_command)
	cmake -S . -B build/deb -DCMAKE_INSTALL_PREFIX=/usr -DHANGPOSE_CARGO_DIR=$(cargo_dir) -DHANGPOSE_COMMAND=$(command_file)
	cmake --build build/deb --target all hangpose_command
	cd build/deb && cpack -B $(CURDIR)/build

dist:
	@scripts/setup.sh dist
	scripts/dist.sh

abi: lib
	scripts/abi.sh --write

samples: setup
	cargo run --release -p host-tests --example samples

clean:
	cargo clean
	rm -rf build
