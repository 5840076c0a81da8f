//! How hand-made shapes hang, whose kinds are known.

use hangpose::Params;
use hangpose::hanging::{HangingPose, Request};
use hangpose::mechanics::Kind;
use hangpose::sample_supporter;
use host_tests::judge::{Scene, freedom};
use host_tests::predicted;
use host_tests::shapes::vector::{V, X, Y, Z, arc, rounded, scale};
use host_tests::shapes::{Builder, HangObject, OBJECTS, Random, SUPPORTERS, Support, joined, meant};
use host_tests::solid::Solid;

/// Number of points of a supporter's cloud.
const POINTS: usize = 6000;

/// The best poses of an object on a supporter, best first.
fn poses(object: &Solid, supporter: &Solid, request: &Request, params: &Params) -> Vec<HangingPose> {
    let cloud = sample_supporter(&supporter.mesh(), POINTS, 1);
    predicted(&object.mesh(), &cloud.cloud().unwrap(), request, params, 5)
}

/// Checks how the best pose hangs: by the motions that free the object, and by the predictor.
fn check(object: &Builder, supporter: &Builder, kind: Kind) {
    let (object, supporter) = (object.finish(), supporter.finish());
    let found = poses(&object, &supporter, &Request::ANY, &Params::default());
    let rest = found.first().expect("a pose").rest.unwrap();
    assert_eq!(freedom(&Scene::new(&object, &supporter), &rest.pose.cast()), Some(kind), "by motion");
    assert_eq!(rest.kind, kind, "by the predictor");
}

/// A peg of this radius in front of a wall, 10 cm long, that rises a little towards its end.
fn peg(radius: f64) -> Builder {
    let mut builder = Builder::default();
    builder.cuboid([-0.015, -0.05, -0.05], [0.0, 0.05, 0.05]);
    builder.tube(&[[-0.001, 0.0, 0.0], [0.1, 0.0, 0.02]], radius);
    builder
}

/// A rail in front of a wall, closed at both ends.
fn rail() -> Builder {
    let mut builder = Builder::default();
    builder.tube(&[[0.07, -0.15, 0.0], [0.07, 0.15, 0.0]], 0.006);
    for y in [-0.14, 0.14] {
        builder.tube(&[[-0.001, y, 0.0], [0.07, y, 0.0]], 0.005);
        builder.cuboid([-0.012, y - 0.03, -0.03], [0.0, y + 0.03, 0.03]);
    }
    builder
}

#[test]
fn a_ring_on_a_peg_is_threaded() {
    let mut ring = Builder::default();
    ring.tube(&arc([0.0; 3], scale(X, 0.03), scale(Y, 0.03), [0.0, 360.0], 32), 0.004);
    check(&ring, &peg(0.006), Kind::Threaded);
}

#[test]
fn an_open_hook_on_a_rail_is_hooked() {
    let mut hook = Builder::default();
    let mut path: Vec<V> = vec![[0.0, 0.0, -0.1], [0.0, 0.0, -0.022]];
    path.extend(arc([0.0; 3], scale(X, 0.02), scale(Z, 0.02), [-70.0, 190.0], 20));
    hook.tube(&path, 0.003);
    hook.ball([0.0, 0.0, -0.11], 0.018);
    check(&hook, &rail(), Kind::Hooked);
}

#[test]
fn a_cap_on_an_upright_peg_is_capped() {
    let mut cap = Builder::default();
    // Open below, with a thick wall, so that its centre of mass is below its ground.
    let (radius, wall, height) = (0.035, 0.005, 0.09);
    cap.revolve(&[
        [[0.0, height], [0.0, height - wall]],
        [[radius, height], [radius - wall, height - wall]],
        [[radius, 0.0], [radius - wall, 0.0]],
    ]);
    let mut stand = Builder::default();
    stand.cuboid([-0.08, -0.08, 0.0], [0.08, 0.08, 0.015]);
    stand.tube(&[[0.0, 0.0, 0.014], [0.0, 0.0, 0.18]], 0.012);
    check(&cap, &stand, Kind::Capped);
}

/// Two prongs in front of a wall, side by side.
fn fork() -> Builder {
    let mut fork = Builder::default();
    fork.cuboid([-0.015, -0.05, -0.05], [0.0, 0.05, 0.05]);
    for y in [-0.015, 0.015] {
        fork.tube(&[[-0.001, y, 0.0], [0.09, y, 0.02]], 0.004);
    }
    fork
}

#[test]
fn a_lollipop_between_two_prongs_is_hooked() {
    let mut lollipop = Builder::default();
    lollipop.ball([0.0; 3], 0.02);
    lollipop.tube(&[[0.0; 3], [0.0, 0.0, -0.15]], 0.004);
    lollipop.ball([0.0, 0.0, -0.16], 0.022);
    check(&lollipop, &fork(), Kind::Hooked);
}

/// A level beam with a flat top, 7 cm wide.
fn beam() -> Solid {
    let mut beam = Builder::default();
    beam.cuboid([-0.02, -0.1, -0.1], [0.05, 0.0, 0.05]);
    beam.cuboid([-0.02, -0.001, -0.02], [0.05, 0.2, 0.0]);
    beam.finish()
}

#[test]
fn a_flat_board_on_a_beam_is_at_most_balanced() {
    let mut board = Builder::default();
    board.cuboid([-0.06, -0.03, -0.002], [0.06, 0.03, 0.002]);
    let params = Params { min_probability: 0.0, ..Params::default() };
    let found = poses(&board.finish(), &beam(), &Request::ANY, &params);
    assert!(found.iter().all(|pose| pose.rest.unwrap().kind == Kind::Balanced));
}

/// Half the width and the height of a carabiner along the middle of its wire, and the radius of the wire, m.
const CARABINER: [f64; 3] = [0.02, 0.04, 0.004];

#[test]
fn a_closed_carabiner_on_a_peg_is_threaded() {
    let [wide, tall, radius] = CARABINER;
    let corners = [[-wide, -tall, 0.0], [wide, -tall, 0.0], [wide, tall, 0.0], [-wide, tall, 0.0]];
    let mut carabiner = Builder::default();
    carabiner.tube(&rounded(&corners, 0.9 * wide, true), radius);
    check(&carabiner, &peg(0.003), Kind::Threaded);
}

#[test]
fn a_carabiner_with_its_gate_open_on_a_peg_is_hooked() {
    let [wide, tall, radius] = CARABINER;
    // The gap of 12 mm is in the middle of a long side, between the round ends of the wire.
    let end = 0.006 + radius;
    let corners = [
        [-wide, -end, 0.0],
        [-wide, -tall, 0.0],
        [wide, -tall, 0.0],
        [wide, tall, 0.0],
        [-wide, tall, 0.0],
        [-wide, end, 0.0],
    ];
    let mut carabiner = Builder::default();
    carabiner.tube(&rounded(&corners, 0.9 * wide, false), radius);
    check(&carabiner, &peg(0.003), Kind::Hooked);
}

#[test]
fn a_mug_on_a_mug_tree_hangs_by_its_handle() {
    let mug = OBJECTS.iter().find(|kind| kind.name == "mug").unwrap();
    let tree = SUPPORTERS.iter().find(|kind| kind.name == "mug tree").unwrap();
    let pairs = (0..).map(|seed| (mug.make(seed), tree.make(seed)));
    for (mug, tree) in pairs.filter(|(mug, tree)| meant(mug, tree) == Some(Kind::Threaded)).take(3) {
        let (HangObject { solid: mug, openings }, Support { solid: tree, bars }) = (&mug, &tree);
        let found = poses(mug, tree, &Request::ANY, &Params::default());
        let rest = found[0].rest.unwrap();
        assert_eq!(rest.kind, Kind::Threaded);
        assert_eq!(joined((mug, openings), (tree, bars), &rest.pose).map(|j| j.kind), Some(Kind::Threaded));
    }
}

#[test]
fn clothes_hangers_hang_by_their_hook_and_not_by_their_frame() {
    let hanger = OBJECTS.iter().find(|kind| kind.name == "clothes hanger").unwrap();
    for name in ["mug tree", "L hook", "coat hook"] {
        let supporter = SUPPORTERS.iter().find(|kind| kind.name == name).unwrap();
        let frame = |seed| Random::named(name, seed).rotation();
        let pairs = (0..).map(|seed| (hanger.make(seed).turned(frame(seed)), supporter.make(seed)));
        let pairs = pairs.filter(|(hanger, supporter)| meant(hanger, supporter) == Some(Kind::Hooked));
        for (HangObject { solid, openings }, Support { solid: supporter, bars }) in pairs.take(3) {
            let found = poses(&solid, &supporter, &Request::ANY, &Params::default());
            let rest = found[0].rest.unwrap();
            let joint = joined((&solid, &openings), (&supporter, &bars), &rest.pose);
            assert_eq!(joint.map(|joint| joint.kind), Some(Kind::Hooked), "on a {name}");
        }
    }
}
