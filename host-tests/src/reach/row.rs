//! One line of a record: a problem, the planner's answer, and what the replay says of it.

use crate::judge::replay::{DEEPEST, Replayed};
use crate::shapes::Insertion;
use hangpose::motion::{PlanCounts, PlanFailure};
use serde::{Deserialize, Serialize};

/// A problem and its answers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the pair.
    pub pair: String,
    /// Kind of the object.
    pub object: String,
    /// Kind of the supporter.
    pub supporter: String,
    /// What stands around, or how object and supporter enclose each other.
    pub scene: String,
    /// Whether a gripper holds the object.
    pub gripper: bool,
    /// Whether there is a way, by construction; `None` if there is no pose that hangs.
    pub insertion: Option<Insertion>,
    /// What the planner says; `None` if there was nothing to plan.
    pub plan: Option<Planned>,
    /// What OMPL's RRT-Connect finds.
    pub peer: Option<Peer>,
}

/// A plan.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Planned {
    /// "path", or the reason why there is none.
    pub answer: String,
    /// The reason in full.
    pub message: String,
    /// Time for the plan alone, s.
    pub seconds: f64,
    /// Working memory, bytes: all of it, and that for the tree over the points of the scene.
    pub bytes: [usize; 2],
    /// Poses sampled.
    pub samples: usize,
    /// Nodes of the trees.
    pub nodes: usize,
    /// Poses tested for collision.
    pub poses: usize,
    /// Waypoints of the object.
    pub waypoints: usize,
    /// Least distance on the path by the planner, m.
    pub clearance: f32,
    /// Penetration depth in Bullet at the start that is given, and at the release pose, m: what the problem itself is worth.
    pub ends: [Option<f64>; 2],
    /// What happened when the path was replayed.
    pub replay: Option<Outcome>,
}

impl Planned {
    /// The answer with its counts.
    pub fn new(
        answer: &Result<(), PlanFailure>,
        counts: &PlanCounts,
        seconds: f64,
        bytes: [usize; 2],
    ) -> Self {
        let (answer, message) = match answer {
            Ok(()) => (PATH.into(), String::new()),
            Err(failure) => (reason(failure).into(), failure.to_string()),
        };
        Self {
            answer,
            message,
            seconds,
            bytes,
            samples: counts.samples,
            nodes: counts.nodes,
            poses: counts.poses,
            waypoints: 0,
            clearance: 0.0,
            ends: [None; 2],
            replay: None,
        }
    }

    /// Whether a path was found.
    pub fn is_found(&self) -> bool {
        self.answer == PATH
    }
}

/// The answer if there is a path.
const PATH: &str = "path";

/// What happened when a path was replayed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Largest penetration depth of the object before the release pose, m, and the place on the path.
    pub way: [f64; 2],
    /// The same from the release pose on.
    pub lowering: [f64; 2],
    /// The same of the gripper that holds the object.
    pub held: [f64; 2],
    /// The same of the gripper while it opens and leaves.
    pub leaving: [f64; 2],
    /// Whether the object hangs when it is let go at the end; `None` if it need not.
    pub hangs: Option<bool>,
    /// Whether it also comes free when gravity is reversed there.
    pub comes_free: bool,
    /// Whether nothing is deeper than 1 mm and the object hangs.
    pub passes: bool,
}

impl Outcome {
    /// Whether nothing is deeper than 1 mm.
    pub fn is_free(&self) -> bool {
        [self.way, self.lowering, self.held, self.leaving].iter().all(|[depth, _]| *depth <= DEEPEST)
    }
}

impl From<&Replayed> for Outcome {
    fn from(replayed: &Replayed) -> Self {
        let Replayed { way, lowering, held, leaving, .. } = replayed;
        let [way, lowering, held, leaving] = [way, lowering, held, leaving].map(|it| [it.depth, it.at]);
        let (hangs, comes_free) = (Some(replayed.hangs()), replayed.verdict.honest);
        Self { way, lowering, held, leaving, hangs, comes_free, passes: replayed.passes() }
    }
}

/// What OMPL finds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peer {
    /// Whether it finds a path that reaches the goal within its time.
    pub is_solved: bool,
    /// Time, s.
    pub seconds: f64,
    /// Poses tested for collision.
    pub poses: usize,
}

/// A failure in a few words.
fn reason(failure: &PlanFailure) -> &'static str {
    match failure {
        PlanFailure::GoalInCollision(_) => "goal in collision",
        PlanFailure::StartInCollision(_) => "start in collision",
        PlanFailure::GoalOutsideWorkspace => "goal outside of the workspace",
        PlanFailure::StartOutsideWorkspace => "start outside of the workspace",
        PlanFailure::Enclosed { .. } => "enclosed",
        PlanFailure::BudgetUsedUp { .. } => "budget used up",
        PlanFailure::TreesFull { .. } => "trees full",
        PlanFailure::GripperCannotOpen(_) => "gripper cannot open",
        PlanFailure::GripperCannotLeave => "gripper cannot leave",
        PlanFailure::Stopped(_) => "stopped",
    }
}
