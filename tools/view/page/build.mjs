// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node build.mjs OUT: page.html, first.js, page.js and page.css, with every package bundled in.

import { build } from 'esbuild';
import { copyFile } from 'node:fs/promises';
import { join, resolve } from 'node:path';

const out = process.argv[2];
// Of three only what calculates: its renderers are more than all the rest, and none is used.
const core = {
  name: 'core',
  setup: ({ onResolve }) => onResolve({ filter: /^three$/ }, () => ({
    path: resolve('node_modules/three/build/three.core.js'), sideEffects: false })),
};
await build({
  entryPoints: { first: 'src/first.ts', page: 'src/main.tsx' },
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  jsx: 'automatic',
  jsxImportSource: 'preact',
  legalComments: 'eof',
  plugins: [core],
  logLevel: 'warning',
});
await copyFile('src/page.html', join(out, 'page.html'));
