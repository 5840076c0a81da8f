//! Examples at the end of each help. A test runs them beside `samples/`.

pub(super) const COMMAND: &str = "\
Example:
  hangpose predict --object samples/mug.obj --supporter samples/hook.ply";

pub(super) const PREDICT: &str = "\
Examples:
  hangpose predict --object samples/mug.obj --supporter samples/hook.ply
  hangpose predict --object samples/scissors.obj --supporter samples/mug_tree.ply --top 3 --json poses.json";

pub(super) const PLAN: &str = "\
Example:
  hangpose predict --object samples/mug.obj --supporter samples/hook.ply --json poses.json
  hangpose plan --object samples/mug.obj --supporter samples/hook.ply --pose poses.json --start samples/mug_start.json";

pub(super) const VIEW: &str = "\
Example:
  hangpose predict --object samples/mug.obj --supporter samples/hook.ply --json poses.json
  hangpose view poses.json --object samples/mug.obj --supporter samples/hook.ply --view page.html --png picture.png";

pub(super) const INSPECT: &str = "\
Examples:
  hangpose inspect samples/mug.obj
  hangpose inspect samples/hook.obj --as supporter";

pub(super) const SCAN: &str = "\
Example:
  hangpose scan --depth samples/mug_depth.png --camera samples/mug_camera.txt --complete --output mug.ply";

pub(super) const BATCH: &str = "\
Examples:
  hangpose batch samples/pairs.csv --output results.parquet --top 3
  hangpose batch samples/pairs.csv --output part-1.csv --shard 1/2 --resume
  hangpose batch samples/pairs.csv --output part-2.csv --shard 2/2 --resume
  hangpose merge samples/pairs.csv part-1.csv part-2.csv --output results.csv";

pub(super) const MERGE: &str = "\
Example:
  hangpose batch samples/pairs.csv --output part-1.csv --shard 1/2
  hangpose batch samples/pairs.csv --output part-2.csv --shard 2/2
  hangpose merge samples/pairs.csv part-1.csv part-2.csv --output results.parquet";

pub(super) const COMPLETIONS: &str = "\
Example:
  hangpose completions bash > hangpose.bash";

pub(super) const MAN: &str = "\
Example:
  hangpose man man1";
