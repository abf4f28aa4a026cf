// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Everything that `reconstruct` takes, on sliders: each change solves again in the background.

import GUI from 'lil-gui';
import { useEffect, useRef, useState } from 'preact/hooks';

import { post } from './api';
import { CopyLine } from './copy';
import { addKnob, makeGui } from './knobs';
import { useNews } from './news';
import type { Run } from './run';
import { useValue, type Table } from './state';
import type { OptionInfo, SolveValues } from './types';

// The paper's five, by her names.
const FIVE = ['lambda-t', 'lambda-f', 'lambda-sep', 'd-near', 'd-far'];
const KNOWN: [string, string, string][] = [
  ['speed', 'speed MEAN,SD [m/s]', 'mean speed over the flock, and how sure that is'],
  ['wingspan', 'wingspan MEAN,SD [m]', 'tip to tip, and its sd between animals'],
];

// "0.7,0.034999999999999996" as a person would write it.
const rounded = (text: string): string =>
  text && text.split(',').map((x) => Number(Number(x).toPrecision(6))).join(',');

function depthRange(run: Run): [number, number] {
  const { camera, bounds } = run.session;
  if (!camera || !bounds) return [0, 200];
  const reach = Math.hypot(...bounds.low.map((x, k) => Math.max(Math.abs(x), Math.abs(bounds.high[k]))));
  return [0, Math.ceil(2 * reach)];
}

function build(run: Run, container: HTMLElement, values: SolveValues, changed: () => void): GUI {
  const gui = makeGui(container);
  const range = depthRange(run);
  const method = { method: values.method };
  const folders: Record<string, GUI[]> = { batch: [], cobyla: [] };
  const showMethod = () => {
    for (const [name, list] of Object.entries(folders)) {
      for (const folder of list) folder.show(name === values.method);
    }
  };
  gui.add(method, 'method', ['batch', 'cobyla']).onChange((value: string) => {
    values.method = value;
    showMethod();
    changed();
  });
  const known = gui.addFolder('What you know');
  for (const [name, words, help] of KNOWN) {
    values[name] = rounded(String(values[name] ?? ''));
    const held = { value: values[name] as string };
    const controller = known.add(held, 'value').name(words);
    controller.onFinishChange((value: string) => {
      values[name] = value.trim();
      changed();
    });
    controller.domElement.title = help;
  }
  for (const name of ['near', 'far']) {
    const held = { value: Number(values[name] ?? 0) };
    const controller = known.add(held, 'value', 0, range[1], 0.5).name(`${name} [m] (0: none)`);
    controller.onChange((value: number) => {
      values[name] = value > 0 ? value : null;
      changed();
    });
  }
  const sizes = { value: values['no-size'] !== true };
  known.add(sizes, 'value').name('use sizes').onChange((value: boolean) => {
    values['no-size'] = !value;
    changed();
  });
  const add = (folder: GUI, option: OptionInfo) => {
    const group = values[option.group as 'batch' | 'cobyla'];
    const depth = option.name === 'd-near' || option.name === 'd-far';
    const knob = { ...option, value: group[option.name],
      low: depth ? 0 : option.low, high: depth ? range[1] : option.high };
    if (depth) {
      const held = { value: Number(knob.value) };
      const controller = folder.add(held, 'value', 0, range[1], 0.5).name(`${option.name} [m]`);
      controller.domElement.title = option.help;
      controller.domElement.dataset.knob = option.name;
      controller.onChange((value: number) => {
        group[option.name] = value;
        changed();
      });
      return;
    }
    addKnob(folder, knob, (value) => {
      group[option.name] = value as number | boolean;
      changed();
    });
  };
  const options = run.session.solve.options;
  const five = gui.addFolder('The paper’s five');
  const rest = gui.addFolder('More of cobyla').close();
  const priors = gui.addFolder('Priors of flight');
  const more = gui.addFolder('More of batch').close();
  folders.cobyla.push(five, rest);
  folders.batch.push(priors, more);
  for (const option of options) {
    if (option.group === 'cobyla') add(FIVE.includes(option.name) ? five : rest, option);
    else add(/window|overlap|iterations|knot|estimate/.test(option.name) ? more : priors, option);
  }
  showMethod();
  return gui;
}

export function SolvePanel({ run }: { run: Run }) {
  const host = useRef<HTMLDivElement>(null);
  const [round, setRound] = useState(0);
  const news = useNews(run, () => run.solve);
  const command = useNews(run, () => run.command);
  const solved = useNews(run, () => run.versions.after > 0);
  const table = useValue(run.store, (s) => s.table);
  const { reason } = run.session.solve;

  useEffect(() => {
    if (!host.current || reason) return;
    const values = structuredClone(run.session.solve.values);
    let timer = 0;
    const send = () => {
      post<{ job: number; command: string }>('api/solve', values)
        .then((answer) => {
          run.says(answer.job, answer.command);
          run.store.set({ message: '' });
        })
        .catch((error: unknown) => run.store.fail(error));
    };
    const gui = build(run, host.current, values, () => {
      clearTimeout(timer);
      timer = window.setTimeout(send, 40);
    });
    if (round > 0) send();
    return () => gui.destroy();
  }, [round]);

  if (reason) return <div class="panel-body"><p class="muted">{reason}</p></div>;
  const share = news?.state === 'running' && news.total ? news.done! / news.total : 0;
  return (
    <div class="panel-body solve">
      <div class="progress" data-state={news?.state ?? 'idle'}>
        <progress max="1" value={news?.state === 'running' ? share : news?.state === 'done' ? 1 : 0} />
        <span>
          {!news && 'move a slider: the flock is solved again'}
          {news?.state === 'accepted' && 'accepted, waits for the solve before it to stop'}
          {news?.state === 'running' && (news.total ? `solving … ${Math.round(100 * share)} %` : 'setting up the equations')}
          {news?.state === 'done' && `solved in ${news.seconds!.toFixed(2)} s`}
          {news?.state === 'failed' && `failed: ${news.text}`}
          {news?.state === 'cancelled' && 'cancelled'}
        </span>
        {(news?.state === 'accepted' || news?.state === 'running') && (
          <button onClick={() => void post('api/cancel')}>cancel</button>)}
      </div>
      <div class="buttons">
        {(['before', 'after'] as Table[]).map((name) => (
          <button class={table === name ? 'on' : ''} disabled={name === 'after' && !solved}
            title="before or after (B with shift)" onClick={() => run.store.set({ table: name })}>
            {name}</button>
        ))}
        <button title="the options of the run" onClick={() => setRound(round + 1)}>reset and solve</button>
      </div>
      <div ref={host} class="knobs" />
      {news?.state === 'done' && news.text && <p class="muted">{news.text}.</p>}
      {news?.warnings?.map((w) => <p class="warning">{w}</p>)}
      <CopyLine text={command} />
    </div>
  );
}
