// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Strokes over the picture become tracks: how many animals fly along them, and for how long.

import { useEffect, useLayoutEffect, useState } from 'preact/hooks';

import { post } from './api';
import { CopyLine } from './copy';
import type { FootageView } from './footage';
import { useNews } from './news';
import type { Run } from './run';
import type { SolveValues } from './types';

export function SketchPanel({ run, footage, fit }:
  { run: Run; footage: FootageView; fit: () => void }) {
  const [frames, setFrames] = useState(90);
  const [count, setCount] = useState(footage.strokes.length);
  const [command, setCommand] = useState('');
  const news = useNews(run, () => run.solve);
  useLayoutEffect(() => { // before anybody can draw
    footage.onStroke = (stroke) => {
      footage.strokes.push(stroke);
      setCount(footage.strokes.length);
    };
    return () => (footage.onStroke = null);
  }, []);
  // The new flock may be far from where the old one was.
  useEffect(() => {
    if (news?.state === 'done' && command) fit();
  }, [news?.state, news?.job, command]);
  const clear = () => {
    footage.strokes = [];
    setCount(0);
    run.clock.redraw();
  };
  const solve = async () => {
    const { first, end } = run.clock;
    const strokes = footage.strokes.map((points) => ({
      first, last: Math.min(first + frames - 1, end), points }));
    try {
      await post('api/sketch', { strokes });
      const values: SolveValues = { ...run.session.solve.values, source: 'sketch', 'no-size': true };
      if (!values.speed && !(values.near && values.far)) values.speed = '10,2';
      const answer = await post<{ command: string }>('api/solve', values);
      setCommand(answer.command);
      run.clock.go(first);
    } catch (error) {
      run.store.fail(error);
    }
  };
  return (
    <div class="panel-body">
      <p>Draw over the picture: each stroke is the way of one animal, flown at an even pace.</p>
      <label class="row wide">each lasts
        <input type="range" min="10" max={Math.max(run.clock.end - run.clock.first + 1, 11)} value={frames}
          onInput={(e) => setFrames(Number(e.currentTarget.value))} />
        <output>{frames} frames</output>
      </label>
      <div class="buttons">
        <button disabled={count === 0} onClick={() => void solve()}>find depth of {count} strokes</button>
        <button disabled={count === 0} onClick={clear}>clear</button>
      </div>
      {news?.state === 'done' && command && <p class="muted">solved in {news.seconds!.toFixed(2)} s; shown as “after”.</p>}
      {command && <CopyLine text={command} />}
    </div>
  );
}
