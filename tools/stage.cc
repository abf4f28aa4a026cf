// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/stage.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <utility>

#include "simulate/core/atomic_file.h"
#include "simulate/core/build_id.h"
#include "simulate/core/check.h"
#include "tools/progress_bar.h"
#include "tools/version.h"

namespace flocklift {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void AddFile(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || fs::is_directory(path)) {
      throw InputError(path.string(), 0, "cannot be read", "check that the file is there");
    }
    std::vector<char> buffer(std::size_t{1} << 20);
    while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
           file.gcount() > 0) {
      EVP_DigestUpdate(context_.get(), buffer.data(), static_cast<std::size_t>(file.gcount()));
    }
  }
  void AddText(std::string_view text) {
    EVP_DigestUpdate(context_.get(), text.data(), text.size());
  }
  std::string Hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string text;
    for (unsigned int k = 0; k < size; ++k) text += fmt::format("{:02x}", digest.at(k));
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

std::string Sha256OfInput(const fs::path& path) {
  if (!fs::is_directory(path)) return Sha256OfFile(path);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  Sha256 hash;
  for (const fs::path& file : files) hash.AddFile(file);
  return hash.Hex();
}

}  // namespace

std::string Sha256OfFile(const fs::path& path) {
  Sha256 hash;
  hash.AddFile(path);
  return hash.Hex();
}

std::string Sha256OfText(std::string_view text) {
  Sha256 hash;
  hash.AddText(text);
  return hash.Hex();
}

void RequireFile(const fs::path& path, const std::string& mend) {
  if (!fs::exists(path)) throw InputError(path.string(), 0, "no such file", mend);
}

Stage::Stage(std::string name, const CommonOptions& common)
    : name_(std::move(name)), common_(common) {}

Stage::~Stage() = default;

void Stage::AddInput(const fs::path& path) {
  inputs_.push_back({{"name", path.string()}, {"sha256", Sha256OfInput(path)}});
}

Json Stage::Fingerprint() const {
  return {{"command", name_},
          {"version", kVersion},
          {"build", BuildId()},
          {"options", options_},
          {"inputs", inputs_}};
}

bool Stage::IsUpToDate() const {
  if (!common_.reuse) return false;
  std::ifstream file(common_.out / ("summary." + name_ + ".json"));
  if (!file) return false;
  const Json summary = Json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (!summary.is_object()) return false;
  const Json fingerprint = Fingerprint();
  for (const auto& [key, value] : fingerprint.items()) {
    if (!summary.contains(key) || summary.at(key) != value) return false;
  }
  if (!summary.contains("outputs") || !summary.at("outputs").is_array()) return false;
  for (const Json& output : summary.at("outputs")) {
    if (!output.is_object()) return false;
    const fs::path path = common_.out / output.value("name", "");
    if (!fs::is_regular_file(path) || Sha256OfFile(path) != output.value("sha256", ""))
      return false;
  }
  if (!common_.quiet) fmt::print(stderr, "{}: up to date\n", name_);
  return true;
}

Progress Stage::BeginPhase(const std::string& name, const std::string& unit) {
  EndPhase();
  phases_.push_back({.name = name});
  wall_start_ = std::chrono::steady_clock::now();
  cpu_start_ = CpuSeconds();
  in_phase_ = true;
  if (common_.quiet) return {};
  bar_ = std::make_unique<ProgressBar>(name_ + " " + name, unit);
  return [this](std::int64_t done, std::int64_t total) {
    if (bar_) bar_->Update(done, total);
  };
}

void Stage::EndPhase() {
  if (!in_phase_) return;
  in_phase_ = false;
  bar_.reset();
  Phase& phase = phases_.back();
  phase.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start_).count();
  phase.cpu_s = CpuSeconds() - cpu_start_;
  if (common_.verbose) {
    fmt::print(stderr, "{} {}: {}, cpu {}\n", name_, phase.name, DurationText(phase.wall_s),
               DurationText(phase.cpu_s));
  }
}

void Stage::SplitPhase(const std::string& name, double wall_s, double cpu_s) {
  Check(!in_phase_ && !phases_.empty(), "only a phase that has ended can be split");
  Phase& whole = phases_.back();
  whole.wall_s = std::max(0.0, whole.wall_s - wall_s);
  whole.cpu_s = std::max(0.0, whole.cpu_s - cpu_s);
  phases_.insert(phases_.end() - 1, {.name = name, .wall_s = wall_s, .cpu_s = cpu_s});
}

void Stage::Warn(const std::string& message) {
  warnings_.push_back(message);
  if (!common_.quiet) fmt::print(stderr, "flocklift {}: warning: {}\n", name_, message);
}

void Stage::Finish() {
  EndPhase();
  Json summary = Fingerprint();
  Json& outputs = summary["outputs"] = Json::array();
  for (const std::string& output : outputs_) {
    outputs.push_back({{"name", output}, {"sha256", Sha256OfFile(common_.out / output)}});
  }
  Json& phases = summary["phases"] = Json::array();
  double wall = 0;
  for (const Phase& phase : phases_) {
    phases.push_back({{"name", phase.name}, {"wall_s", phase.wall_s}, {"cpu_s", phase.cpu_s}});
    wall += phase.wall_s;
  }
  summary["figures"] = figures_;
  summary["warnings"] = warnings_;
  const std::string text =
      summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  WriteTextFile(common_.out / ("summary." + name_ + ".json"), text);
  if (common_.json) {
    std::cout << text << std::flush;
  } else if (!common_.quiet) {
    std::string files;
    for (const std::string& output : outputs_) files += " " + output;
    fmt::print(stderr, "{}: {} -> {}:{}\n", name_, DurationText(wall), common_.out.string(), files);
    for (const auto& [key, value] : figures_.items()) {
      if (!value.is_structured()) fmt::print(stderr, "  {}: {}\n", key, value.dump());
    }
  }
}

}  // namespace flocklift
