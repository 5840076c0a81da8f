// The picture: the scene in three dimensions, the camera and the labels. It is drawn only when something changed.

import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  CapsuleGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DirectionalLight,
  DoubleSide,
  GridHelper,
  Group,
  HemisphereLight,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  LinearFilter,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  Object3D,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Quaternion,
  Scene as ThreeScene,
  Sphere,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { CSS2DObject, CSS2DRenderer } from "three/addons/renderers/CSS2DRenderer.js";
import { toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { axesOf } from "./axes";
import { percent } from "./format";
import { matrixOf } from "./motion";
import type { Sequence } from "./motion";
import type { Contact, Fallen, HangingPose, Points as Cloud, Scene, Vec3 } from "./scene";
import { PALETTES } from "./theme";
import type { Colour, Theme } from "./theme";

/** Vertical angle of view, degrees. */
const FIELD_OF_VIEW = 32;
/** Edges of the object that are sharper than this look sharp, radians. */
const CREASE = 0.6;
/** Triangles of all ghosts together: what a laptop without a graphics card still turns smoothly. */
const GHOST_TRIANGLES = 400_000;
/** Points of which the distance to their neighbours is measured. */
const SPACING_SAMPLES = 60;
/** Radius of the disc of a supporter point, in median distances between neighbours: closes most of the surface. */
const DISC = 1.9;
/** How much wider than the image on the page a saved picture is. */
const PICTURE_SCALE = 2;
/** Contact force below which an arrow gets no shorter, multiples of the weight. */
const LEAST_FORCE = 0.08;
/** Contact force from which its arrow has a label, multiples of the weight. */
const WORTH_A_LABEL = 0.1;
/** Angle of the first view above the horizon, radians. */
const ELEVATION = 0.35;
/** Of so many supporter points one is asked whether it stands before the object. */
const STRIDE = 5;
/** Directions around the object of which the first view is the best. */
const DIRECTIONS = 24;

export interface Layer {
  id: string;
  label: string;
  colour: Colour | null;
  on: boolean;
}

const Y = new Vector3(0, 1, 0);
const Z = new Vector3(0, 0, 1);
/** Size that stands for things without points, metres. */
const EMPTY = new Vector3(0.1, 0.1, 0.1);

function geometryOf(positions: Float32Array): BufferGeometry {
  return new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
}

/** Median distance from a point to its nearest neighbour, metres. */
function spacing(positions: Float32Array): number {
  const count = positions.length / 3;
  const found: number[] = [];
  for (let s = 0; s < SPACING_SAMPLES && count > 1; s++) {
    const i = Math.floor((s * count) / SPACING_SAMPLES);
    let nearest = Infinity;
    for (let j = 0; j < count; j++) {
      const dx = positions[3 * i]! - positions[3 * j]!;
      const dy = positions[3 * i + 1]! - positions[3 * j + 1]!;
      const dz = positions[3 * i + 2]! - positions[3 * j + 2]!;
      const d = dx * dx + dy * dy + dz * dz;
      if (d > 0 && d < nearest) nearest = d;
    }
    if (nearest < Infinity) found.push(Math.sqrt(nearest));
  }
  found.sort((a, b) => a - b);
  return found[Math.floor(found.length / 2)] ?? 0;
}

function drawn(size: number, draw: (context: CanvasRenderingContext2D) => void): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  draw(canvas.getContext("2d")!);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.generateMipmaps = false;
  texture.minFilter = LinearFilter;
  return texture;
}

function disc(): CanvasTexture {
  return drawn(64, (c) => {
    c.fillStyle = "#fff";
    c.arc(32, 32, 30, 0, 7);
    c.fill();
  });
}

/** The usual sign for a centre of mass: a disc with quarters in black and white. */
function centreOfMassSign(): CanvasTexture {
  return drawn(64, (c) => {
    for (let quarter = 0; quarter < 4; quarter++) {
      c.fillStyle = quarter % 2 ? "#fff" : "#111";
      c.beginPath();
      c.moveTo(32, 32);
      c.arc(32, 32, 27, (quarter * Math.PI) / 2, ((quarter + 1) * Math.PI) / 2);
      c.fill();
    }
    c.strokeStyle = "#111";
    c.lineWidth = 4;
    c.beginPath();
    c.arc(32, 32, 28, 0, 7);
    c.stroke();
  });
}

function boxOf(positions: Float32Array): Box3 {
  const box = new Box3();
  const point = new Vector3();
  for (let i = 0; i + 2 < positions.length; i += 3) box.expandByPoint(point.fromArray(positions, i));
  return box;
}

export class View {
  readonly layers: Layer[] = [];
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.001, 100);
  /** Called after each drawn frame. */
  onDrawn: () => void = () => {};

  private readonly renderer: WebGLRenderer;
  private readonly labels = new CSS2DRenderer();
  private readonly controls: OrbitControls;
  private readonly three = new ThreeScene();
  private readonly up: Vector3;
  private readonly groups = new Map<string, Object3D[]>();
  private readonly tinted: { material: { color: Color }; colour: Colour }[] = [];
  private readonly hemisphere = new HemisphereLight(0xffffff, 0x8d8d95, 1.7);
  private readonly round = disc();
  private readonly objectGeometry: BufferGeometry;
  private readonly objectMaterial = new MeshStandardMaterial({ roughness: 0.6, side: DoubleSide });
  private readonly ghostMaterial = new MeshLambertMaterial({ transparent: true, depthWrite: false, side: DoubleSide });
  private readonly object = new Group();
  private readonly gripper = new Group();
  private readonly gripperParts: { mesh: Mesh; opening: Vector3; middle: Vector3 }[] = [];
  private readonly forces = new Group();
  private readonly forceMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly released = new Group();
  private readonly others = new Group();
  private readonly fell = new Group();
  private readonly trail = new Group();
  private readonly trailMaterial = new LineBasicMaterial({ depthTest: false, transparent: true });
  private readonly nextView = new Group();
  private readonly grid = new Group();
  private readonly box: Box3;
  private readonly radius: number;
  private readonly centre: Vector3;
  private framed = new Sphere();
  private free = 0;
  private chosen: HangingPose | null = null;
  private scheduled = false;
  private theme: Theme = "light";
  gridCell = 0;

  constructor(
    private readonly host: HTMLElement,
    private readonly scene: Scene,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.domElement.tabIndex = 0;
    this.renderer.domElement.setAttribute("role", "img");
    this.labels.domElement.className = "labels";
    this.labels.domElement.setAttribute("aria-hidden", "true");
    host.append(this.renderer.domElement, this.labels.domElement);

    this.up = new Vector3(...scene.supporter.up).normalize();
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());

    const key = new DirectionalLight(0xffffff, 1.6);
    key.position.set(-0.6, 0.9, 1);
    this.camera.add(key);
    this.hemisphere.position.copy(this.up);
    this.three.add(this.camera, this.hemisphere);

    this.box = boxOf(scene.object.positions);
    if (this.box.isEmpty()) this.box.setFromCenterAndSize(new Vector3(...scene.object.centreOfMass), EMPTY);
    this.radius = this.box.getSize(new Vector3()).length() / 2;
    this.centre = this.box.getCenter(new Vector3());
    this.objectGeometry = this.addObject();
    this.addSupporter();
    this.addMarks();
    this.addGripper();
    this.addViews();
    this.addGrid();
    for (const layer of this.layers) this.show(layer.id, layer.on);

    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  /** Adds things to a layer, which is listed if it has any. */
  private layer(id: string, label: string, colour: Colour | null, on: boolean, things: Object3D[]): void {
    this.groups.set(id, things);
    this.layers.push({ id, label, colour, on });
  }

  private tint<M extends { color: Color }>(material: M, colour: Colour): M {
    this.tinted.push({ material, colour });
    return material;
  }

  private dots(positions: Float32Array, colour: Colour, metres: number): Points {
    const size = metres / Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const material = new PointsMaterial({ size, map: this.round, alphaTest: 0.5 });
    return new Points(geometryOf(positions), this.tint(material, colour));
  }

  /** Points with a short line along each normal. */
  private needles({ positions, normals }: Cloud, colour: Colour, metres: number): Group {
    const ends = new Float32Array(2 * positions.length);
    for (let i = 0; i < normals.length; i++) {
      const at = 6 * Math.floor(i / 3) + (i % 3);
      ends[at] = positions[i]!;
      ends[at + 3] = positions[i]! + 3 * metres * normals[i]!;
    }
    const lines = new LineSegments(geometryOf(ends), this.tint(new LineBasicMaterial(), colour));
    return new Group().add(this.dots(positions, colour, metres), lines);
  }

  /** Discs on the surface, which the light shades by their normals. */
  private discs({ positions, normals }: Cloud, colour: Colour): Object3D {
    const apart = spacing(positions);
    if (normals.length === 0) return this.dots(positions, colour, 2 * apart);
    const material = this.tint(new MeshLambertMaterial({ side: DoubleSide }), colour);
    const mesh = new InstancedMesh(new CircleGeometry(DISC * apart, 7), material, positions.length / 3);
    const [at, out, turn, one] = [new Vector3(), new Vector3(), new Quaternion(), new Vector3(1, 1, 1)];
    const matrix = new Matrix4();
    for (let i = 0; i < mesh.count; i++) {
      turn.setFromUnitVectors(Z, out.fromArray(normals, 3 * i).normalize());
      mesh.setMatrixAt(i, matrix.compose(at.fromArray(positions, 3 * i), turn, one));
    }
    mesh.frustumCulled = false;
    return mesh;
  }

  private addObject(): BufferGeometry {
    const { object } = this.scene;
    const indexed = geometryOf(object.positions).setIndex(new BufferAttribute(object.indices, 1));
    const geometry = toCreasedNormals(indexed, CREASE);
    const mesh = new Mesh(geometry, this.tint(this.objectMaterial, "object"));
    this.tint(this.ghostMaterial, "object");
    this.object.matrixAutoUpdate = false;
    this.object.add(mesh);
    this.three.add(this.object);
    this.layer("object", "Object", "object", true, [mesh]);
    return geometry;
  }

  private addSupporter(): void {
    const { supporter, obstacles } = this.scene;
    const seen = this.discs(supporter.points, "supporter");
    this.three.add(seen);
    this.layer("supporter", "Supporter as seen", "supporter", true, [seen]);
    if (supporter.guessed.length > 0) {
      const guessed = this.dots(supporter.guessed, "guessed", 1.2 * spacing(supporter.guessed));
      this.three.add(guessed);
      this.layer("guessed", "Supporter, guessed", "guessed", true, [guessed]);
    }
    if (obstacles.length > 0) {
      const things = this.dots(obstacles, "obstacles", 0.6 * spacing(obstacles));
      this.three.add(things);
      this.layer("obstacles", "Obstacles", "obstacles", true, [things]);
    }
  }

  private addMarks(): void {
    const { object, supporter, poses, fallen } = this.scene;
    const sign = new Sprite(new SpriteMaterial({ map: centreOfMassSign(), sizeAttenuation: false, depthTest: false }));
    sign.scale.setScalar(0.017);
    sign.position.set(...object.centreOfMass);
    sign.renderOrder = 3;
    this.object.add(sign);
    this.tint(this.forceMaterial, "force");
    this.tint(this.trailMaterial, "trail");
    this.three.add(this.forces, this.released, this.others, this.fell, this.trail);
    if (poses.some((pose) => pose.contacts.length > 0)) {
      this.layer("forces", "Contact forces", "force", true, [this.forces]);
    }
    this.layer("centre", "Centre of mass", null, true, [sign]);
    if (poses.length + fallen.length > 0) {
      this.layer("trail", "Way of the centre of mass", "trail", true, [this.trail]);
      this.layer("release", "Release pose", "object", false, [this.released]);
    }
    if (poses.length > 1) this.layer("others", "Other poses", "object", false, [this.others]);
    if (fallen.length > 0) {
      this.fell.add(
        ...this.ghosts(
          fallen.map((one) => matrixOf(one.release)),
          "fallen",
        ),
      );
      this.layer("fallen", "Released, but fell", "fallen", false, [this.fell]);
    }
    const small = this.radius / 90;
    if (object.contacts.positions.length > 0) {
      const needles = this.needles(object.contacts, "objectContacts", 1.5 * small);
      this.object.add(needles);
      this.layer("objectContacts", "Contact candidates, object", "objectContacts", false, [needles]);
    }
    if (supporter.contacts.positions.length > 0) {
      const needles = this.needles(supporter.contacts, "supporterContacts", 1.5 * small);
      this.three.add(needles);
      this.layer("supporterContacts", "Contact candidates, supporter", "supporterContacts", false, [needles]);
    }
    if (object.samples.length > 0) {
      const samples = this.dots(object.samples, "samples", small);
      this.object.add(samples);
      this.layer("samples", "Samples of the object", "samples", false, [samples]);
    }
  }

  private addGripper(): void {
    const material = this.tint(new MeshStandardMaterial({ roughness: 0.5 }), "gripper");
    for (const { from, to, radius, opening } of this.scene.gripper?.parts ?? []) {
      const [a, b] = [new Vector3(...from), new Vector3(...to)];
      const along = b.clone().sub(a);
      const mesh = new Mesh(new CapsuleGeometry(radius, along.length(), 6, 20), material);
      const middle = a.add(b).multiplyScalar(0.5);
      mesh.position.copy(middle);
      if (along.lengthSq() > 0) mesh.quaternion.setFromUnitVectors(Y, along.normalize());
      this.gripper.add(mesh);
      this.gripperParts.push({ mesh, opening: new Vector3(...opening), middle });
    }
    this.gripper.matrixAutoUpdate = false;
    if (this.gripperParts.length === 0) return;
    const shown = new Group().add(this.gripper);
    this.three.add(shown);
    this.layer("gripper", "Gripper", "gripper", true, [shown]);
  }

  /** A camera as a pyramid with its tip at the place of the camera. */
  private cameraSign(
    at: Vector3,
    towards: Vector3,
    up: Vector3,
    size: number,
    material: LineBasicMaterial,
  ): LineSegments {
    const forward = towards.clone().sub(at).normalize();
    const side = forward.clone().cross(up);
    if (side.lengthSq() < 1e-6) side.set(1, 0, 0).cross(forward);
    side.normalize().multiplyScalar(0.6 * size);
    const top = side
      .clone()
      .cross(forward)
      .normalize()
      .multiplyScalar(0.45 * size);
    const middle = at.clone().addScaledVector(forward, size);
    const corners = [
      [1, 1],
      [1, -1],
      [-1, -1],
      [-1, 1],
    ].map(([s, t]) => middle.clone().addScaledVector(side, s!).addScaledVector(top, t!));
    const ends = corners.flatMap((corner, i) => [at, corner, corner, corners[(i + 1) % 4]!]);
    return new LineSegments(new BufferGeometry().setFromPoints(ends), material);
  }

  private addViews(): void {
    const { object, supporter, poses } = this.scene;
    const material = this.tint(new LineBasicMaterial(), "camera");
    const size = this.radius / 3;
    if (object.viewpoints.length > 0) {
      const cameras = new Group();
      for (const at of object.viewpoints) {
        cameras.add(this.cameraSign(new Vector3(...at), this.centre, Z, size, material));
      }
      this.object.add(cameras);
      this.layer("objectCameras", "Cameras that saw the object", "camera", false, [cameras]);
    }
    if (supporter.viewpoints.length > 0) {
      const cameras = new Group();
      const middle = boxOf(supporter.points.positions).getCenter(new Vector3());
      for (const at of supporter.viewpoints) {
        cameras.add(this.cameraSign(new Vector3(...at), middle, this.up, size, material));
      }
      this.three.add(cameras);
      this.layer("supporterCameras", "Cameras that saw the supporter", "camera", false, [cameras]);
    }
    const helps = (pose: HangingPose) =>
      pose.unseen && (Math.hypot(...pose.unseen.object_view) > 0 || Math.hypot(...pose.unseen.supporter_view) > 0);
    if (poses.some(helps)) {
      this.three.add(this.nextView);
      this.layer("nextView", "Next view that would help", "nextView", true, [this.nextView]);
    }
  }

  private addGrid(): void {
    const { supporter, poses } = this.scene;
    const box = boxOf(supporter.points.positions);
    for (const pose of poses.slice(0, 1)) {
      box.union(this.objectBox(matrixOf(pose.rest ?? pose.release)));
    }
    if (box.isEmpty()) box.setFromCenterAndSize(new Vector3(), EMPTY);
    const extent = 1.6 * box.getSize(new Vector3()).length();
    const rough = extent / 14;
    const decade = 10 ** Math.floor(Math.log10(rough));
    this.gridCell = decade * ([1, 2, 5, 10].find((step) => step * decade >= rough) ?? 10);
    const cells = 2 * Math.ceil(extent / this.gridCell / 2);
    const lines = new GridHelper(cells * this.gridCell, cells);
    const material = this.tint(new LineBasicMaterial({ transparent: true, opacity: 0.5 }), "grid");
    lines.material = material;
    lines.geometry.deleteAttribute("color");
    lines.quaternion.setFromUnitVectors(Y, this.up);
    let lowest = Infinity;
    for (let corner = 0; corner < 8; corner++) {
      const at = new Vector3(
        ...([0, 1, 2].map((k) => (corner & (1 << k) ? box.max : box.min).getComponent(k)) as [number, number, number]),
      );
      lowest = Math.min(lowest, at.dot(this.up));
    }
    const centre = box.getCenter(new Vector3());
    lines.position.copy(centre).addScaledVector(this.up, lowest - 0.02 * extent - centre.dot(this.up));
    this.grid.add(lines);
    this.three.add(this.grid);
    this.layer("grid", "Grid", "grid", true, [this.grid]);
    this.layer("labels", "Labels", null, true, []);
  }

  /** Paler copies of the object at the given places, as many as can be drawn, and a dot for each. */
  private ghosts(matrices: Matrix4[], colour: Colour): Object3D[] {
    const each = Math.max(this.objectGeometry.getAttribute("position").count / 3, 1);
    const count = Math.min(matrices.length, Math.max(Math.floor(GHOST_TRIANGLES / each), 1));
    const material = new MeshLambertMaterial({ transparent: true, opacity: 0.1, depthWrite: false });
    const mesh = new InstancedMesh(this.objectGeometry, this.tint(material, colour), count);
    for (let i = 0; i < count; i++) mesh.setMatrixAt(i, matrices[Math.floor((i * matrices.length) / count)]!);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    const centres = matrices.flatMap((matrix) =>
      new Vector3(...this.scene.object.centreOfMass).applyMatrix4(matrix).toArray(),
    );
    const dots = this.dots(new Float32Array(centres), colour, this.radius / 18);
    this.paint();
    return [mesh, dots];
  }

  private objectBox(matrix: Matrix4): Box3 {
    return this.box.clone().applyMatrix4(matrix);
  }

  /** Sets what belongs to a pose: its contacts, its release pose, the others, the view that would help and its way. */
  choose(pose: HangingPose | null, fallen: Fallen | null, sequence: Sequence | null): void {
    for (const group of [this.forces, this.released, this.others, this.trail, this.nextView]) this.clear(group);
    if (pose) {
      for (const contact of pose.contacts) this.addForce(contact.position, contact.normal, contact.force);
      this.addNextViews(pose);
    }
    this.chosen = pose;
    this.addOthers();
    const release = pose?.release ?? fallen?.release;
    if (release) {
      const ghost = new Mesh(this.objectGeometry, this.ghostMaterial);
      this.ghostMaterial.opacity = 0.3;
      ghost.applyMatrix4(matrixOf(release));
      ghost.renderOrder = 1;
      this.released.add(ghost);
    }
    if (sequence) {
      const line = new Line(new BufferGeometry().setFromPoints([...sequence.object.line]), this.trailMaterial);
      line.renderOrder = 2;
      this.trail.add(line);
    }
    this.draw();
  }

  /** The other poses, if they are to be seen: they may be many. */
  private addOthers(): void {
    if (!this.chosen || !this.isOn("others") || this.others.children.length > 0) return;
    const others = this.scene.poses
      .filter((other) => other !== this.chosen)
      .map((other) => matrixOf(other.rest ?? other.release));
    this.others.add(...this.untinted(() => this.ghosts(others, "object")));
  }

  /** Materials that are made for one pose are forgotten with it. */
  private untinted<T>(make: () => T): T {
    const kept = this.tinted.length;
    const made = make();
    this.tinted.length = kept;
    return made;
  }

  /** Empties a group and gives back the memory of what was made for it. */
  private clear(group: Group): void {
    group.traverse((thing) => {
      if (thing instanceof CSS2DObject) thing.element.remove();
      if (thing instanceof InstancedMesh) thing.dispose();
      if (
        (thing instanceof Mesh || thing instanceof Line || thing instanceof Points) &&
        thing.geometry !== this.objectGeometry
      ) {
        thing.geometry.dispose();
      }
    });
    group.clear();
  }

  /** Length of the arrow of a force, given in multiples of the weight. */
  private lengthOf(force: number): number {
    return Math.max(force, LEAST_FORCE) * 0.6 * this.radius;
  }

  private addForce(position: Vec3, normal: Vec3, force: number): void {
    const length = this.lengthOf(force);
    const thick = 0.013 * this.radius;
    const head = Math.min(7 * thick, 0.5 * length);
    const shaft = new Mesh(new CylinderGeometry(thick, thick, length - head, 12), this.forceMaterial);
    shaft.position.y = (length - head) / 2;
    const tip = new Mesh(new ConeGeometry(2.6 * thick, head, 20), this.forceMaterial);
    tip.position.y = length - head / 2;
    const foot = new Mesh(new SphereGeometry(1.8 * thick, 16, 12), this.forceMaterial);
    const arrow = new Group().add(shaft, tip, foot);
    if (force >= WORTH_A_LABEL)
      arrow.add(this.label(`${percent(force)} of the weight`, "force", new Vector3(0, length, 0)));
    arrow.position.set(...position);
    arrow.quaternion.setFromUnitVectors(Y, new Vector3(...normal).normalize());
    arrow.traverse((thing) => (thing.renderOrder = 4));
    this.forces.add(arrow);
  }

  private addNextViews(pose: HangingPose): void {
    const rest = matrixOf(pose.rest ?? pose.release);
    const turn = new Quaternion().setFromRotationMatrix(rest);
    const centre = this.centre.clone().applyMatrix4(rest);
    const { object_view, supporter_view } = pose.unseen ?? {
      object_view: [0, 0, 0] as Vec3,
      supporter_view: [0, 0, 0] as Vec3,
    };
    const add = (direction: Vector3, distance: number, name: string) => {
      if (direction.lengthSq() === 0) return;
      const material = new LineBasicMaterial({ color: new Color(PALETTES[this.theme].nextView) });
      const at = centre.clone().addScaledVector(direction.normalize(), distance * this.radius);
      const sign = this.cameraSign(at, centre, this.up, this.radius / 3, material);
      const ray = new Line(new BufferGeometry().setFromPoints([at, centre]), material);
      const label = this.label(name, "nextView", at);
      label.center.set(0.5, 1.3);
      this.nextView.add(sign, ray, label);
    };
    add(new Vector3(...object_view).applyQuaternion(turn), 1.7, "Next view: object");
    add(new Vector3(...supporter_view), 1.9, "Next view: supporter");
  }

  private label(text: string, kind: string, at: Vector3): CSS2DObject {
    const element = document.createElement("span");
    element.className = `label ${kind}`;
    element.textContent = text;
    const label = new CSS2DObject(element);
    label.position.copy(at);
    label.center.set(-0.06, 0.5);
    return label;
  }

  /** Places the object and the gripper. */
  place(matrix: Matrix4, gripper: { matrix: Matrix4; opening: number } | null, resting: boolean): void {
    this.object.matrix.copy(matrix);
    this.object.matrixWorldNeedsUpdate = true;
    this.gripper.visible = gripper !== null;
    if (gripper) {
      this.gripper.matrix.copy(gripper.matrix);
      this.gripper.matrixWorldNeedsUpdate = true;
      for (const { mesh, opening, middle } of this.gripperParts) {
        mesh.position.copy(middle).addScaledVector(opening, gripper.opening);
      }
    }
    this.forces.visible = resting && this.isOn("forces");
    this.draw();
  }

  /** Where the object is drawn. */
  objectMatrix(): Matrix4 {
    this.object.updateWorldMatrix(true, true);
    return this.object.children[0]!.matrixWorld;
  }

  isOn(id: string): boolean {
    return this.layers.find((layer) => layer.id === id)?.on ?? false;
  }

  show(id: string, on: boolean): void {
    const layer = this.layers.find((one) => one.id === id);
    if (!layer) return;
    layer.on = on;
    for (const thing of this.groups.get(id) ?? []) thing.visible = on;
    if (id === "others") this.addOthers();
    if (id === "labels") this.labels.domElement.hidden = !on;
    this.draw();
  }

  seeThrough(on: boolean): void {
    Object.assign(this.objectMaterial, { transparent: on, opacity: on ? 0.35 : 1, depthWrite: !on, needsUpdate: true });
    this.draw();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.renderer.setClearColor(new Color(PALETTES[theme].background));
    this.hemisphere.groundColor.set(PALETTES[theme].ground);
    this.paint();
    this.draw();
  }

  private paint(): void {
    for (const { material, colour } of this.tinted) material.color.set(PALETTES[this.theme][colour]);
  }

  /** What is to be seen of the object at these places: it, its contacts, and the supporter near it. */
  private sphere(places: readonly Matrix4[], contacts: readonly Contact[]): Sphere {
    const box = new Box3();
    for (const place of places) box.union(this.objectBox(place));
    for (const { position, normal, force } of contacts) {
      box.expandByPoint(new Vector3(...normal).multiplyScalar(this.lengthOf(force)).add(new Vector3(...position)));
    }
    const near = box.clone().expandByScalar(0.5 * this.radius);
    const { positions } = this.scene.supporter.points;
    const point = new Vector3();
    for (let i = 0; i + 2 < positions.length; i += 3) {
      if (near.containsPoint(point.fromArray(positions, i))) box.expandByPoint(point);
    }
    return box.getBoundingSphere(new Sphere());
  }

  /** Looks at the object from the side of the way in which it hangs off the supporter, from a little above. */
  fit(places: readonly Matrix4[], contacts: readonly Contact[]): void {
    this.frame(this.sphere(places, contacts), this.side(places[places.length - 1]!));
  }

  /** Looks at everything: the way, the cameras and the obstacles too. */
  fitAll(): void {
    const box = new Box3();
    this.grid.visible = false;
    this.three.updateMatrixWorld(true);
    this.three.traverseVisible((thing) => {
      if (thing instanceof Mesh || thing instanceof Points || thing instanceof Line) box.expandByObject(thing);
    });
    this.grid.visible = this.isOn("grid");
    if (!box.isEmpty()) this.frame(box.getBoundingSphere(new Sphere()), this.direction());
  }

  /** Frames the object anew, from the same direction, if it leaves what was framed or is small in it. */
  follow(places: readonly Matrix4[], contacts: readonly Contact[]): void {
    const sphere = this.sphere(places, contacts);
    const reach = sphere.center.distanceTo(this.framed.center) + sphere.radius;
    if (reach > 1.15 * this.framed.radius || sphere.radius < 0.65 * this.framed.radius)
      this.frame(sphere, this.direction());
  }

  private direction(): Vector3 {
    return this.camera.position.clone().sub(this.controls.target).normalize();
  }

  /**
   * A direction from which much of the object is seen, and little of the supporter stands before it: rather from the side
   * and the front of the way in which it hangs off the supporter.
   */
  private side(matrix: Matrix4): Vector3 {
    const { ahead, aside } = axesOf(this.up);
    const { positions } = this.scene.supporter.points;
    const centre = this.centre.clone().applyMatrix4(matrix);
    const offset = centre.clone().sub(boxOf(positions).getCenter(new Vector3()));
    offset.addScaledVector(this.up, -offset.dot(this.up));
    if (offset.length() < 0.1 * this.radius) offset.copy(ahead);
    offset.normalize();
    const { x, y, z } = this.box.getSize(new Vector3());
    const faces = [y * z, x * z, x * y];
    const most = Math.hypot(...faces) || 1;
    const axes = [new Vector3(), new Vector3(), new Vector3()];
    matrix.extractBasis(axes[0]!, axes[1]!, axes[2]!);
    const [point, across] = [new Vector3(), new Vector3()];
    const worth = (direction: Vector3): number => {
      const seen = faces.reduce((sum, face, i) => sum + face * Math.abs(direction.dot(axes[i]!)), 0) / most;
      let [near, before] = [1, 0];
      for (let i = 0; i + 2 < positions.length; i += 3 * STRIDE) {
        point.fromArray(positions, i).sub(centre);
        if (point.lengthSq() < 4 * this.radius ** 2) near++;
        const ahead = point.dot(direction);
        if (ahead > 0 && across.copy(point).addScaledVector(direction, -ahead).length() < 0.6 * this.radius) before++;
      }
      const fromTheSide = Math.sqrt(Math.max(1 - direction.dot(offset) ** 2, 0));
      return (
        seen +
        0.3 * fromTheSide +
        0.2 * direction.dot(offset) -
        0.05 * direction.dot(aside) -
        Math.min(before / near, 1)
      );
    };
    let [best, worthOfBest] = [ahead, -Infinity];
    for (let i = 0; i < DIRECTIONS; i++) {
      const angle = (2 * Math.PI * i) / DIRECTIONS;
      const direction = ahead
        .clone()
        .multiplyScalar(Math.cos(angle))
        .addScaledVector(aside, Math.sin(angle))
        .multiplyScalar(Math.cos(ELEVATION))
        .addScaledVector(this.up, Math.sin(ELEVATION));
      const its = worth(direction);
      if (its > worthOfBest) [best, worthOfBest] = [direction, its];
    }
    return best;
  }

  /** A place for an object that hangs nowhere: beside the supporter. */
  beside(): Matrix4 {
    const { ahead } = axesOf(this.up);
    const box = boxOf(this.scene.supporter.points.positions);
    if (box.isEmpty()) return new Matrix4();
    const half = box.getSize(new Vector3()).multiplyScalar(0.5);
    const reach = Math.abs(half.dot(new Vector3(Math.abs(ahead.x), Math.abs(ahead.y), Math.abs(ahead.z))));
    const at = box
      .getCenter(new Vector3())
      .addScaledVector(ahead, reach + 1.2 * this.radius)
      .sub(this.centre);
    return new Matrix4().setPosition(at);
  }

  private frame(sphere: Sphere, direction: Vector3): void {
    this.framed = sphere;
    const half = (FIELD_OF_VIEW * Math.PI) / 360;
    const narrow = Math.min(
      half,
      Math.atan(Math.tan(half) * this.camera.aspect * (1 - this.free / this.host.clientWidth)),
    );
    const distance = (0.97 * sphere.radius) / Math.sin(narrow);
    this.camera.near = distance / 200;
    this.camera.far = distance * 60;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).addScaledVector(direction, distance);
    this.controls.update();
    this.draw();
  }

  /** Draws once before the next frame of the browser. */
  draw(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.drawNow();
    });
  }

  private drawNow(): void {
    this.renderer.render(this.three, this.camera);
    if (this.isOn("labels")) this.labels.render(this.three, this.camera);
    this.onDrawn();
  }

  /** Keeps so many pixels at the left free of what is looked at. */
  keepFree(pixels: number): void {
    if (pixels === this.free) return;
    this.free = pixels;
    this.setLens();
    this.draw();
  }

  private setLens(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    this.camera.aspect = width / height;
    this.camera.setViewOffset(width, height, -this.free / 2, 0, width, height);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.host;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.labels.setSize(clientWidth, clientHeight);
    this.setLens();
    this.drawNow();
  }

  /** The picture as PNG, without the labels. */
  picture(): Promise<Blob> {
    const { clientWidth, clientHeight } = this.host;
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(PICTURE_SCALE);
    this.renderer.setSize(clientWidth, clientHeight);
    this.renderer.render(this.three, this.camera);
    const done = new Promise<Blob>((resolve, reject) =>
      this.renderer.domElement.toBlob((blob) =>
        blob ? resolve(blob) : reject(new Error("the browser gave no picture")),
      ),
    );
    return done.finally(() => {
      this.renderer.setPixelRatio(ratio);
      this.resize();
    });
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }
}
