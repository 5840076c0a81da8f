.DEFAULT_GOAL := help
.PHONY: help setup demo test bench peer samples clean

help:
	@echo "make demo     hang the sample mug on the sample hook"
	@echo "make test     everything that must hold"
	@echo "make bench    how long it takes, in how much memory"
	@echo "make peer     the same beside another implementation: PEER=peer.py [MESHES=folder]"
	@echo "make samples  write samples/ anew"
	@echo "make setup    install what is missing"
	@echo "make clean    remove what was built"

setup:
	@scripts/setup.sh

demo: setup
	@mkdir -p build
	cargo run --release -p hangpose -- predict --object samples/mug.obj --supporter samples/hook.ply --json build/demo.json
	@echo "the poses are in build/demo.json"

test: setup
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings
	cargo test --workspace
	RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
	cargo run --release -p hangpose --example samples -- --check
	scripts/bare-metal.sh

bench: setup
	cargo bench --workspace

peer_python = build/peer/bin/python

$(peer_python): bench/requirements.txt
	python3 -m venv build/peer
	$(peer_python) -m pip install --quiet --requirement bench/requirements.txt
	@touch $@

peer: setup $(peer_python)
	cargo build --release -p hangpose
	$(peer_python) bench/peer.py --peer $(PEER) time samples/mug.obj samples/mug_tree.ply
	$(if $(MESHES),$(peer_python) bench/peer.py --peer $(PEER) agree --meshes $(MESHES))

samples:
	cargo run --release -p hangpose --example samples

clean:
	cargo clean
	rm -rf bare-metal/target build
