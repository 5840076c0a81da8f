// The colours of the picture. Those of the page around it are in style.css.

export type Theme = "light" | "dark";

const light = {
  background: "#f3f4f6",
  ground: "#b4b2b0",
  grid: "#c3c7ce",
  object: "#e8792b",
  supporter: "#7f8fa6",
  guessed: "#a06bd6",
  obstacles: "#c9c2b6",
  gripper: "#4f5b6b",
  force: "#c2185b",
  trail: "#1f6feb",
  fallen: "#8a3b12",
  objectContacts: "#9a1b1b",
  supporterContacts: "#0b7285",
  samples: "#5b3410",
  camera: "#5c6470",
  nextView: "#0f7b45",
};

export type Colour = keyof typeof light;

const dark: Record<Colour, string> = {
  background: "#14171c",
  ground: "#77777c",
  grid: "#353b45",
  object: "#f08a3c",
  supporter: "#8b9bb3",
  guessed: "#b78cf0",
  obstacles: "#625d55",
  gripper: "#aeb9c8",
  force: "#ff5fa2",
  trail: "#6cb0ff",
  fallen: "#d98a5a",
  objectContacts: "#ff8080",
  supporterContacts: "#4fd1e0",
  samples: "#ffd9a8",
  camera: "#a7b0bd",
  nextView: "#4cc98a",
};

export const PALETTES: Record<Theme, Record<Colour, string>> = { light, dark };
