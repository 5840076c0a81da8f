// Scenes for the tests: a ring on a rod, built from formulas.

const f32 = (numbers) => Buffer.from(new Float32Array(numbers).buffer).toString("base64");
const u32 = (numbers) => Buffer.from(new Uint32Array(numbers).buffer).toString("base64");

/** Radius of the ring and of its tube, and of the rod, metres. */
const [RING, TUBE, ROD] = [0.04, 0.006, 0.005];

/** The torus about the x axis as a mesh. */
function torus(around, across) {
  const [positions, indices] = [[], []];
  for (let i = 0; i < around; i++) {
    for (let j = 0; j < across; j++) {
      const [a, b] = [(2 * Math.PI * i) / around, (2 * Math.PI * j) / across];
      const out = RING + TUBE * Math.cos(b);
      positions.push(TUBE * Math.sin(b), out * Math.cos(a), out * Math.sin(a));
      const at = (p, q) => (p % around) * across + (q % across);
      indices.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return { positions, indices };
}

/** Points of the rod along the x axis, with their normals. */
function rod(count) {
  const [points, normals] = [[], []];
  for (let i = 0; i < count; i++) {
    const [x, a] = [0.16 * (((i * 0.618034) % 1) - 0.5), 2 * Math.PI * ((i * 0.414214) % 1)];
    const n = [0, Math.cos(a), Math.sin(a)];
    points.push(x, ROD * n[1], ROD * n[2]);
    normals.push(...n);
  }
  return { points, normals };
}

/** A rotation about x. */
const turned = (position, angle) => ({ position, quaternion_xyzw: [Math.sin(angle / 2), 0, 0, Math.cos(angle / 2)] });

function motion(poses, step) {
  return {
    seconds: f32(poses.map((_, i) => i * step)),
    poses: f32(poses.flatMap((pose) => [...pose.position, ...pose.quaternion_xyzw])),
  };
}

/** A pose of rank `i + 1` at another place of the rod, with a simulated motion that swings. */
export function pose(i) {
  const hang = -(RING - TUBE - ROD);
  const x = 0.01 * ((i % 9) - 4);
  const release = turned([x, 0, hang + 0.001], 0.3 + 0.01 * i);
  const rest = turned([x, 0.0005, hang], 0.02 * i);
  const swing = Array.from({ length: 31 }, (_, k) =>
    turned(
      [x, (0.0005 * k) / 30, hang + 0.001 * (1 - k / 30)],
      0.02 * i + (0.3 - 0.01 * i) * (1 - k / 30) * Math.cos(k / 4),
    ),
  );
  return {
    rank: i + 1,
    release,
    rest,
    kind: ["threaded", "hooked", "capped", "balanced"][i % 4],
    probability: 0.98 / (1 + 0.2 * i),
    robustness: 0.95 / (1 + 0.3 * i),
    sinking: 0.001,
    clearance: 0.001,
    tolerance: { position: 0.0009, rotation: 0.0146 },
    unseen:
      i === 0
        ? { object: 0, shadow: 0, supporter: 0, object_view: [0, 0, 0], supporter_view: [0, 0, 0] }
        : { object: 0.4, shadow: 0.1, supporter: 0.2, object_view: [0.6, 0, 0.8], supporter_view: [0, 1, 0] },
    margin: {
      tilts: i === 0 ? Array(8).fill(1.2) : [0.5, 0.6, 0.9, 1.2, 1.2, 1.1, 0.7, 0],
      jolt_time: i === 0 ? 1 : 0.4,
      tilted_sinking: 1e-6,
      escape_rise: 0.03,
      centre_of_mass_radius: 0.02,
      escape_ratio: 0.7,
      knock_speed: 0.8,
    },
    contacts: [
      { position: [x, 0, ROD], normal: [0, 0, 1], force: 1 },
      { position: [x + 0.004, 0.003, 0.004], normal: [0, 0.6, 0.8], force: 0.2 },
    ],
    motion: motion([release, ...swing.slice(1, -1), rest], 1 / 60),
    path: null,
    path_failure: null,
  };
}

/** A path to a pose from beyond the end of the rod, and of the gripper away from it. */
export function path(pose) {
  const [x] = pose.release.position;
  const start = turned([0.2, 0.05, -0.1], -0.8);
  const waypoints = [
    { seconds: 0, ...start },
    { seconds: 0.4, ...turned([0.12, 0, pose.release.position[2]], 0.1) },
    { seconds: 0.9, ...pose.release },
    { seconds: 1.0, ...pose.rest },
  ];
  return {
    waypoints,
    release: 2,
    clearance: 0.004,
    gripper: [
      { seconds: 1.0, ...pose.rest },
      { seconds: 1.5, ...turned([x, -0.1, -0.06], 0.2) },
    ],
  };
}

/** Everything that a scene may have; `changes` replace parts of it. */
export function scene(changes = {}, { around = 48, across = 16, points = 3000, poses = 4 } = {}) {
  const mesh = torus(around, across);
  const cloud = rod(points);
  const list = Array.from({ length: poses }, (_, i) => pose(i));
  if (list[0]) list[0].path = path(list[0]);
  if (list[1]) list[1].path_failure = { message: "the release pose is enclosed" };
  const fall = (fate, i) => {
    const release = turned([0.02 * i - 0.02, 0.01, 0.03], 0.4 * i);
    const frames = Array.from({ length: 25 }, (_, k) =>
      turned([release.position[0], 0.01 + 0.001 * k, 0.03 - 0.0003 * k * k], 0.4 * i + 0.05 * k),
    );
    return { fate, release, motion: motion(frames, 1 / 60) };
  };
  return {
    schema: 1,
    version: "0.1.0",
    most_tilt: 1.2,
    object: {
      name: "ring <b>&amp;</b>.obj",
      triangle_count: mesh.indices.length / 3,
      positions: f32(mesh.positions),
      indices: u32(mesh.indices),
      centre_of_mass: [0, 0.002, -0.004],
      samples: f32(mesh.positions.slice(0, 300)),
      contacts: { positions: f32([0, 0, RING - TUBE, 0, 0, -RING - TUBE]), normals: f32([0, 0, -1, 0, 0, -1]) },
      viewpoints: [[0.3, 0.1, 0.1]],
    },
    supporter: {
      name: "rod.ply",
      point_count: 120000,
      up: [0, 0, 1],
      points: f32(cloud.points),
      normals: f32(cloud.normals),
      guessed: f32(cloud.points.slice(0, 900).map((v, i) => (i % 3 === 2 ? -Math.abs(v) - 0.001 : v))),
      contacts: { positions: f32([0, 0, ROD]), normals: f32([0, 0, 1]) },
      viewpoints: [[0.1, 0.4, 0.3]],
    },
    obstacles: f32([0.2, 0.2, 0, 0.2, 0.21, 0, 0.2, 0.2, 0.01]),
    gripper: {
      parts: [
        { from: [-0.02, -0.08, 0], to: [-0.02, -0.03, 0], radius: 0.005, opening: [-0.01, 0, 0] },
        { from: [0.02, -0.08, 0], to: [0.02, -0.03, 0], radius: 0.005, opening: [0.01, 0, 0] },
        { from: [0, -0.09, 0], to: [0, -0.09, 0], radius: 0.02, opening: [0, 0, 0] },
      ],
      retreat: [0, -0.1, 0],
    },
    poses: list,
    fallen: ["rotates_off", "slides_off", "moves"].map(fall),
    counts: { released: 9, at_rest: 4, rotated_off: 2, slid_off: 2, moving: 1 },
    rejection: null,
    seconds: { object: 0.064, supporter: 0.036, matching: 0.088 },
    ...changes,
  };
}

/** A scene of the published method: fields that only a simulation gives are null or missing. */
export function published() {
  const { rank, release } = pose(0);
  const bare = {
    rank,
    release,
    rest: null,
    kind: null,
    probability: null,
    robustness: null,
    sinking: null,
    clearance: null,
    tolerance: null,
    unseen: null,
    margin: null,
    contacts: null,
    motion: motion([], 1),
    path: null,
    path_failure: null,
  };
  return scene({
    poses: [bare, { rank: 2, release: pose(3).release, motion: motion([], 1) }],
    fallen: [],
    gripper: null,
    seconds: null,
  });
}

/** A scene in which nothing hangs and every array is empty. */
export function empty() {
  const full = scene();
  const none = { positions: "", normals: "" };
  return {
    ...full,
    poses: [],
    fallen: [],
    obstacles: "",
    gripper: null,
    counts: null,
    seconds: null,
    object: { ...full.object, samples: "", contacts: none, viewpoints: [] },
    supporter: { ...full.supporter, normals: "", guessed: "", contacts: none, viewpoints: [] },
    rejection: { stage: "too_loose", reason: "no released pose stays: most often a small disturbance brings it down" },
  };
}

const TEMPLATE = new URL("../../host/src/view/page.html", import.meta.url);

/** Writes a page as hangpose does. */
export async function page(scene, title) {
  const { readFile } = await import("node:fs/promises");
  const json = JSON.stringify(scene).replaceAll("<", "\\u003c");
  const escaped = title.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  return (await readFile(TEMPLATE, "utf8"))
    .replace("__HANGPOSE_TITLE__", () => escaped)
    .replace("__HANGPOSE_SCENE__", () => json);
}

/** The scene of a page that hangpose wrote. */
export function sceneOf(html) {
  return JSON.parse(/<script type="application\/json" id="scene">(.*?)<\/script>/s.exec(html)[1]);
}
