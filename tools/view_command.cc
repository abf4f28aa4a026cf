// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view_command.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "simulate/core/atomic_file.h"
#include "simulate/core/check.h"
#include "tools/kept_memory.h"
#include "tools/view/export_page.h"
#include "tools/view/folder_view.h"
#include "tools/view/http_server.h"
#include "tools/view/page_files.h"
#include "tools/view/scene_view.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;

// Runs the server until SIGINT or SIGTERM, which are blocked in every thread but the one that waits
// for them: nothing is interrupted in the middle.
class SignalWait {
 public:
  SignalWait() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~SignalWait() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalWait(const SignalWait&) = delete;
  SignalWait& operator=(const SignalWait&) = delete;

  void Run(HttpServer* server) {
    std::thread waiter([this, server] {
      int signal = 0;
      sigwait(&signals_, &signal);
      server->Stop();
    });
    server->Run();
    // If the server ended by itself. The waiter takes the signal as a word, it does not end by it.
    pthread_kill(waiter.native_handle(), SIGTERM);  // NOLINT(bugprone-bad-signal-to-kill-thread)
    waiter.join();
  }

 private:
  sigset_t signals_{}, before_{};
};

void ExportPage(const ViewCommand& command, const PageFiles& page) {
  std::optional<fs::path> truth;
  if (!command.truth.empty()) truth = command.truth;
  Check(fs::is_directory(command.what), "--export needs the folder of a run");
  const RunData data({.folder = command.what,
                      .truth = truth,
                      .fps = command.fps,
                      .large_bytes = std::numeric_limits<std::uint64_t>::max()});
  const std::string html = MakeExportPage(page, data, {.picture_width = command.export_width});
  WriteTextFile(command.out_page, html);
  if (!command.quiet) {
    fmt::print(stderr, "flocklift view: wrote {}, {:.1f} MB\n", command.out_page.string(),
               static_cast<double>(html.size()) / 1e6);
  }
}

}  // namespace

void RunView(const ViewCommand& command) {
  const PageFiles page = EmbeddedPage();
  if (!page.missing.empty())
    throw std::runtime_error("there is no page: " + std::string(page.missing));
  if (!command.out_page.empty()) return ExportPage(command, page);
  SignalWait signals;  // before any thread starts
  KeepFreedMemory();
  if (!fs::exists(command.what)) {
    throw InputError(command.what.string(), 0, "no such folder or scene",
                     "give the folder of a run, or a scene file");
  }
  std::optional<fs::path> truth;
  if (!command.truth.empty()) truth = command.truth;
  std::unique_ptr<FolderView> folder;  // the one or the other; they outlive the server
  std::unique_ptr<SceneView> scene;
  HttpServer server(command.port);
  if (fs::is_directory(command.what)) {
    folder = std::make_unique<FolderView>(
        RunDataOptions{.folder = command.what, .truth = truth, .fps = command.fps},
        command.threads);
    folder->Serve(&server);
  } else {
    scene = std::make_unique<SceneView>(command.what, command.out, command.threads);
    scene->Serve(&server);
  }
  fmt::print("{}\n", server.guard().Address());
  std::fflush(stdout);
  if (!command.quiet) {
    fmt::print(stderr, "flocklift view: open the address in a browser; Ctrl-C ends\n");
  }
  signals.Run(&server);
}

void AddViewCommand(CLI::App& app) {
  auto command = std::make_shared<ViewCommand>();
  CLI::App* sub = app.add_subcommand(
      "view", "Show a run or a scene on a live page: turn the knobs, mend the tracks, steer");
  sub->footer(
      "The page is served to this computer only, at an address with a secret in it.\n"
      "Examples:\n"
      "  flocklift view run                      # look, solve again, mend the tracks\n"
      "  flocklift view demo/result --port 8080\n"
      "  flocklift view run --export page.html   # one page to look at, without a server\n"
      "  flocklift view data_synthetic/boids3d.toml --out scenes");
  sub->add_option("what", command->what, "a folder that `run` filled, or a scene file")
      ->required()
      ->option_text("DIR|SCENE");
  sub->add_option("--port", command->port, "port to listen on; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  sub->add_option("--export", command->out_page,
                  "write one self-contained page to look at, instead of serving")
      ->option_text("PAGE.html");
  sub->add_option("--export-width", command->export_width, "of its pictures, at most [px]")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  sub->add_option("--truth", command->truth,
                  "folder with the truth; default: truth/ in the folder or beside it, if there")
      ->option_text("DIR");
  sub->add_option("--fps", command->fps, "frames per second; overrides what the files say")
      ->check(CLI::PositiveNumber);
  sub->add_option("--out", command->out, "folder for scenes that are saved")->capture_default_str();
  sub->add_option("--threads", command->threads, "threads; 0: one per core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  sub->add_flag("--quiet", command->quiet, "print the address only");
  sub->callback([command] { RunView(*command); });
}

}  // namespace flocklift
