// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node build.mjs OUT: page.js, later.js and page.css, with every package bundled in. later.js is what
// the first picture does without; it uses the page's preact.

import { build } from 'esbuild';
import { resolve } from 'node:path';

const out = process.argv[2];
const options = {
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  jsx: 'automatic',
  jsxImportSource: 'preact',
  legalComments: 'eof',
  logLevel: 'warning',
};
// Of three only what calculates: its renderers are more than all the rest, and none is used.
const core = {
  name: 'core',
  setup: ({ onResolve }) => onResolve({ filter: /^three$/ }, () => ({
    path: resolve('node_modules/three/src/Three.Core.js'), sideEffects: false })),
};
const shared = {
  name: 'shared',
  setup: ({ onResolve, onLoad }) => {
    onResolve({ filter: /^preact/ }, ({ path }) => ({ path, namespace: 'shared' }));
    onLoad({ filter: /.*/, namespace: 'shared' }, ({ path }) => ({
      contents: `module.exports = globalThis.flockliftShared['${path}'];` }));
  },
};
await build({ ...options, entryPoints: { page: 'src/main.tsx' }, plugins: [core] });
await build({ ...options, entryPoints: { later: 'src/later.ts' }, plugins: [shared] });
