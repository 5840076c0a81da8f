//! Supporters.

mod hooks;
mod pegs;
mod stands;

use super::builder::Builder;
use super::vector::{V, X, sub, unit};
use super::{Bar, SupporterKind};

/// All kinds of supporters.
pub const SUPPORTERS: &[SupporterKind] = &[
    SupporterKind { name: "peg", make: pegs::peg },
    SupporterKind { name: "tilted peg", make: pegs::tilted_peg },
    SupporterKind { name: "steep peg", make: pegs::steep_peg },
    SupporterKind { name: "nail", make: pegs::nail },
    SupporterKind { name: "ball-ended hook", make: pegs::ball_hook },
    SupporterKind { name: "pegboard", make: pegs::pegboard },
    SupporterKind { name: "J hook", make: hooks::j_hook },
    SupporterKind { name: "L hook", make: hooks::l_hook },
    SupporterKind { name: "S hook", make: hooks::s_hook },
    SupporterKind { name: "coat hook", make: hooks::coat_hook },
    SupporterKind { name: "double hook", make: hooks::double_hook },
    SupporterKind { name: "carabiner hook", make: hooks::carabiner_hook },
    SupporterKind { name: "mug tree", make: stands::mug_tree },
    SupporterKind { name: "rail", make: stands::rail },
    SupporterKind { name: "rod", make: stands::rod },
    SupporterKind { name: "glass rack", make: stands::glass_rack },
    SupporterKind { name: "fork", make: stands::fork },
];

/// A bar from `root` to `end` in front of a wall at x = 0.
fn bar(root: V, end: V, radius: f64) -> Bar {
    let reach = sub(end, root);
    let direction = unit(reach);
    Bar {
        position: super::vector::single(root),
        direction: super::vector::single(direction),
        length: super::vector::length(reach) as f32,
        radius: radius as f32,
        pass_radius: radius as f32,
        tilt: libm::asin(direction[2]) as f32,
        has_free_end: true,
        wall: Some((super::vector::single(X), root[0] as f32)),
        drop: f32::INFINITY,
        gap: 0.0,
    }
}

/// Adds a wall plate about (0, y, z) with its front at x = 0.
fn plate(builder: &mut Builder, [y, z]: [f64; 2], [width, height]: [f64; 2], thickness: f64) {
    builder.cuboid([-thickness, y - width / 2.0, z - height / 2.0], [0.0, y + width / 2.0, z + height / 2.0]);
}
