.DEFAULT_GOAL := help
.PHONY: help setup demo test bench tables peer samples header clean

help:
	@echo "make demo     hang the sample mug on the sample hook, let go and draw it"
	@echo "make test     everything that must hold"
	@echo "make bench    how long it takes, in how much memory"
	@echo "make peer     the same beside another implementation: PEER=peer.py [MESHES=folder]"
	@echo "make tables   drop 600 pairs in two engines: docs/RESULTS.md [MESHES=folder adds real ones]"
	@echo "make samples  write samples/ anew"
	@echo "make header   write include/hangpose.h anew from ffi/"
	@echo "make setup    install what is missing"
	@echo "make clean    remove what was built"

setup:
	@scripts/setup.sh

demo: setup
	@mkdir -p build
	cargo run --release -p hangpose -- predict --object samples/mug.obj --supporter samples/hook.ply --json build/demo.json
	@echo "the poses are in build/demo.json; this is what becomes of them in Bullet:"
	cargo run --release -p host-tests --bin drop -- --object samples/mug.obj --supporter samples/hook.obj --poses build/demo.json --picture build/demo.png

test: setup
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
	cargo run --release -p hangpose --example samples -- --check
	cargo run -p hangpose-ffi --example header -- --check
	scripts/bare-metal.sh

bench: setup
	cargo bench --workspace

tables: setup
	cargo run --release -p host-tests --bin tables -- $(if $(MESHES),--meshes $(MESHES) --real-pairs 150)

peer_python = build/peer/bin/python

$(peer_python): bench/requirements.txt
	python3 -m venv build/peer
	$(peer_python) -m pip install --quiet --requirement bench/requirements.txt
	@touch $@

peer: setup $(peer_python)
	cargo build --release -p hangpose
	$(peer_python) bench/peer.py --peer $(PEER) time samples/mug.obj samples/mug_tree.ply
	$(if $(MESHES),$(peer_python) bench/peer.py --peer $(PEER) agree --meshes $(MESHES))

header:
	cargo run -p hangpose-ffi --example header

samples:
	cargo run --release -p hangpose --example samples

clean:
	cargo clean
	rm -rf bare-metal/target build
