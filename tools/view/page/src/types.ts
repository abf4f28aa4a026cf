// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the server tells at first (tools/view/folder_view.h, scene_view.h).

export interface CameraInfo {
  width: number;
  height: number;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  gravity: boolean;
  pose: number[] | null; // cam_from_world, rows [r r r t]
  poses: number[]; // 12 a frame, of a moving camera
}

export interface Versions {
  boxes: number;
  before: number;
  after: number;
  curves: number;
  animals: string[];
}

// What of large files is being read, and what is wrong with them (tools/view/late_reader.h).
export interface Reading {
  text: string; // empty: all is read
  faults: string[];
}

export interface Edits {
  reason: string; // why tracks cannot be mended; empty: they can
  lines: string[];
  redo: number;
}

export interface OptionInfo {
  name: string;
  group: string;
  value: number | boolean;
  whole: boolean;
  low: number | null;
  high: number | null;
  unit: string;
  help: string;
}

export type SolveValues = Record<string, unknown> & {
  method: string;
  batch: Record<string, number | boolean>;
  cobyla: Record<string, number | boolean>;
};

export interface Bounds {
  low: number[];
  high: number[];
}

export interface RunSession {
  kind: 'run';
  exported?: boolean;
  name: string;
  fps: number | null;
  frames: { first: number; last: number };
  versions: Versions;
  has: { boxes: boolean; before: boolean; truth: boolean; sd: boolean };
  bounds: Bounds | null;
  camera: CameraInfo | null;
  footage: { width: number; height: number; frames: number; video: boolean } | null;
  noFootage: string;
  edits: Edits;
  solve: { values: SolveValues; options: OptionInfo[]; command: string; reason: string };
  observability: string;
}

export interface ParameterInfo {
  name: string;
  value: number;
  low: number | null;
  high: number | null;
  unit: string;
  help: string;
  choices: string[];
}

export interface SceneSession {
  kind: 'scene';
  name: string;
  dt: number;
  fps: number;
  dimensions: number;
  bounds: Bounds;
  species: { name: string; model: string; help: string; count: number; wingspan: number;
    parameters: ParameterInfo[] }[];
  predators: number;
  goals: { species: string; reach: number }[];
  obstacles: { vertices: number[]; triangles: number[] }[];
  paths: [number, number, number][][]; // lines along the guidance curves
  camera: CameraInfo | null;
  wind: number[];
}

export type Session = RunSession | SceneSession;

export interface Series {
  frames: number[];
  depth: (number | null)[];
  speed: (number | null)[];
  neighbour: (number | null)[];
  polarisation: (number | null)[];
  sd_depth?: (number | null)[];
}

export interface Suspect {
  frame: number;
  id: string;
  other: string;
  what: string;
  doubt: number;
}

export interface SolveNews {
  job?: number;
  state: 'accepted' | 'running' | 'done' | 'failed' | 'cancelled';
  done?: number;
  total?: number;
  seconds?: number;
  animals?: number;
  iterations?: number;
  cost?: number;
  converged?: boolean;
  text?: string;
  warnings?: string[];
}
