// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tools to mend tracks, where they may be wrong, and what was changed.

import { address } from './api';
import type { Mending } from './mending';
import { useNews } from './news';
import type { Run } from './run';
import { useValue } from './state';

const WORDS: Record<string, string> = {
  meeting: 'two meet',
  jump: 'jumps',
  gap: 'not seen',
  start: 'begins here',
  end: 'ends here',
  // the tracker's words
  swap: 'swapped?',
  merge: 'behind another',
  join: 'joined?',
  break: 'broken off',
};

export function MendPanel({ run, mending }: { run: Run; mending: Mending }) {
  const edits = useNews(run, () => run.edits);
  const suspects = useNews(run, () => run.suspects);
  const tool = useNews(run, () => mending.tool);
  const at = useNews(run, () => mending.at);
  const selected = useValue(run.store, (s) => s.selected);
  const second = useValue(run.store, (s) => s.second);
  if (edits.reason) return <div class="panel-body"><p class="muted">{edits.reason}</p></div>;
  const name = (animal: number) => (animal >= 0 ? run.animals[animal] : '–');
  return (
    <div class="panel-body mend">
      <p class="chosen">
        <b>{name(selected)}</b> and <b>{name(second)}</b>
        <span class="muted"> · click selects, shift-click the second</span>
      </p>
      <div class="tools">
        <button title="from this frame on they change places" onClick={() => void mending.swap()}>swap <kbd>x</kbd></button>
        <button title="from this frame on it is another" onClick={() => void mending.split()}>split <kbd>c</kbd></button>
        <button title="the second goes on as the first" onClick={() => void mending.join()}>join <kbd>j</kbd></button>
        <button title="the track goes" onClick={() => void mending.remove()}>delete <kbd>Del</kbd></button>
        <button class={tool === 'pin' ? 'on' : ''} title="it is here in this frame: click the place"
          onClick={() => mending.choose('pin')}>pin <kbd>p</kbd></button>
        <button class={tool === 'add' ? 'on' : ''} title="an animal that was missed: click the place"
          onClick={() => mending.choose('add')}>add <kbd>a</kbd></button>
        <button disabled={edits.lines.length === 0} onClick={() => void mending.undo()}>undo <kbd>z</kbd></button>
        <button disabled={edits.redo === 0} onClick={() => void mending.redo()}>redo <kbd>y</kbd></button>
      </div>
      {tool !== 'none' && <p class="hint">Click the place in the footage, or bring the crosshair there (<kbd>k</kbd>, arrows, <kbd>Enter</kbd>).</p>}
      <section class="suspects">
        <header>
          <h3>{suspects.length} to look at</h3>
          <button title="the next in order of doubt" onClick={() => mending.jump(1)}>next <kbd>n</kbd></button>
        </header>
        <ol>
          {suspects.slice(0, 100).map((s, k) => (
            <li class={k === at ? 'selected' : ''}>
              <button onClick={() => mending.jump(k - mending.at)}>
                <meter min="0" max="1" value={s.doubt} />
                <span>{s.id}{s.other && ` · ${s.other}`}</span>
                <span class="muted">{WORDS[s.what] ?? s.what}</span>
                <span class="frame">{s.frame}</span>
              </button>
            </li>
          ))}
        </ol>
      </section>
      <section class="edits">
        <h3>{edits.lines.length} corrections</h3>
        {edits.lines.length > 0 && (
          <>
            <pre>{edits.lines.join('\n')}</pre>
            <p class="muted">
              Saved in <a href={address('files/corrections.txt')}>corrections.txt</a>; `flocklift run
              VIDEO --corrections` takes it.
            </p>
          </>
        )}
      </section>
    </div>
  );
}
