// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A run's folder, live: what the page asks for to show it, solve it again and mend its tracks.
//   GET  /api/session                     what there is, as JSON
//   GET  /api/window?what&first&last      rows of some frames (frame_table.h); what: boxes, before
//                                         (of the file), after (solved here), truth
//   GET  /api/series?what[&animal]        curves over time
//   GET  /api/suspects                    where tracks may be wrong
//   GET  /frame/N?width                   frame N as JPEG
//   GET  /video, /files/NAME              the footage, a file of the folder
//   POST /api/solve, /api/cancel          options as in summary.reconstruct.json
//   POST /api/edit, /api/undo, /api/redo  {"line": "swap 3 7 120"}
//   POST /api/sketch                      strokes (sketch.h), written as sketch_tracks.csv
// News: "solve" (state, done, total ..), "data" (versions of what /api/window gives), "edits",
// "suspects" (there are new ones), "reading" (late_reader.h).

#ifndef FLOCKLIFT_TOOLS_VIEW_FOLDER_VIEW_H_
#define FLOCKLIFT_TOOLS_VIEW_FOLDER_VIEW_H_

#include <memory>

#include "tools/view/http_server.h"
#include "tools/view/run_data.h"

namespace flocklift {

class FolderView {
 public:
  // Reads the folder, but for what is large (run_data.h); `threads` are those of a solve, 0: all
  // that the machine has. Throws InputError for a folder that is none, or whose files are damaged.
  FolderView(const RunDataOptions& options, int threads);
  ~FolderView();

  // Adds the routes; the view must outlive the server's Run.
  void Serve(HttpServer* server);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FOLDER_VIEW_H_
