// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the page shows after its first picture: a script of its own (build.mjs), so that a browser
// that starts has less to read before.

import { Charts } from './charts';
import { LiveCharts } from './liveCharts';
import { LookPanel } from './lookPanel';
import { MendPanel } from './mendPanel';
import { SketchPanel } from './sketchPanel';
import { SolvePanel } from './solvePanel';
import { SteerPanel } from './steerPanel';

const parts = { Charts, LiveCharts, LookPanel, MendPanel, SketchPanel, SolvePanel, SteerPanel };
export type Parts = typeof parts;
window.flockliftParts = parts;
