//! The pairs: made by the shape library from a seed, or real ones from a folder of meshes.

use crate::shapes::{OBJECTS, ObjectKind, SUPPORTERS, fits};
use crate::solid::Solid;
use hangpose::files::CloudFile;
use hangpose::sample_supporter;
use std::sync::Arc;

/// Points of a supporter's cloud.
const POINTS: usize = 10_000;

/// An object and a supporter, and whether they go together.
#[derive(Clone)]
pub struct Case {
    /// Names the pair; the same in every run with the same seed.
    pub name: String,
    /// Seed of the samples.
    pub seed: u64,
    /// Kind of the object.
    pub object_kind: String,
    /// Kind of the supporter.
    pub supporter_kind: String,
    /// Whether the object can hang on the supporter.
    pub fit: Fit,
    /// The object.
    pub object: Arc<Solid>,
    /// The supporter.
    pub supporter: Arc<Solid>,
}

impl Case {
    /// The point cloud as which the predictor sees the supporter: [`POINTS`] samples of its surface.
    pub fn supporter_cloud(&self) -> CloudFile {
        sample_supporter(&self.supporter.mesh(), POINTS, self.seed)
    }
}

/// Whether an object can hang on a supporter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fit {
    /// It can, by geometry.
    Yes,
    /// It cannot, by geometry or by the manifest.
    No,
    /// The object can hang, by the manifest; whether on this supporter a search has to find out.
    Unknown,
}

/// Sizes are drawn anew so often until a pair fits; then the pair is taken with another supporter.
const TRIES: u64 = 30;

/// `pairs` pairs that fit, every hangable kind of object and every kind of supporter in turn, and two thirds as
/// many that cannot hang.
pub fn made(pairs: usize, seed: u64) -> Vec<Case> {
    let kinds =
        |is_hangable| OBJECTS.iter().filter(move |kind| kind.is_hangable == is_hangable).collect::<Vec<_>>();
    let (hangable, unhangable) = (kinds(true), kinds(false));
    let mut cases = Vec::new();
    let mut turn = 0;
    while cases.len() < pairs {
        let object = hangable[turn % hangable.len()];
        // One supporter further with each round through the objects, so that all meet all.
        let supporter = turn / hangable.len() + turn;
        cases.extend(
            (0..TRIES).find_map(|k| made_case(object, supporter, seed, turn as u64 * TRIES + k, true)),
        );
        turn += 1;
    }
    let unhangable_pairs = (0..2 * pairs / 3).filter_map(|turn| {
        made_case(
            unhangable[turn % unhangable.len()],
            turn / unhangable.len() + turn,
            seed,
            turn as u64,
            false,
        )
    });
    cases.extend(unhangable_pairs);
    cases
}

/// Objects and supporters that go together only, or also, with contacts on both sides of the centre of mass.
const SEVERAL: [(&str, &str); 4] =
    [("goblet", "glass rack"), ("goblet", "fork"), ("clothes hanger", "rail"), ("racquet", "fork")];

/// At most `pairs` pairs that fit and bear, or may bear, on several contacts.
pub fn several(pairs: usize, seed: u64) -> Vec<Case> {
    let each = pairs.div_ceil(SEVERAL.len());
    let of = |(object, supporter): (&str, &str)| {
        let object = OBJECTS.iter().find(|kind| kind.name == object).expect("a kind of object");
        let supporter =
            SUPPORTERS.iter().position(|kind| kind.name == supporter).expect("a kind of supporter");
        let draws =
            (0..each as u64 * TRIES).filter_map(move |draw| made_case(object, supporter, seed, draw, true));
        draws.take(each)
    };
    SEVERAL.into_iter().flat_map(of).collect()
}

/// The pair with these sizes, if it fits as asked.
fn made_case(object: &ObjectKind, supporter: usize, seed: u64, draw: u64, should_fit: bool) -> Option<Case> {
    let supporter = &SUPPORTERS[supporter % SUPPORTERS.len()];
    let sizes = seed << 32 | draw;
    let made = (object.make(2 * sizes), supporter.make(2 * sizes + 1));
    if fits(&made.0, &made.1) != should_fit {
        return None;
    }
    Some(Case {
        name: format!("{}-{}-{seed}-{draw}", object.name, supporter.name),
        seed: draw,
        object_kind: object.name.into(),
        supporter_kind: supporter.name.into(),
        fit: if should_fit { Fit::Yes } else { Fit::No },
        object: Arc::new(made.0.solid),
        supporter: Arc::new(made.1.solid),
    })
}
