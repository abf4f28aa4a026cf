// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Things by name, such as models and force terms: what there is, with units, ranges and defaults,
// and the checked way from what a file says (ModelSpec) to the numbers. Each thing is a struct of
// parameters with a Describe (simulate/core/options.h); `Parameters` is a variant of them.

#ifndef FLOCKLIFT_SIMULATE_FLOCK_REGISTRY_H_
#define FLOCKLIFT_SIMULATE_FLOCK_REGISTRY_H_

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "simulate/core/options.h"
#include "simulate/core/scene.h"

namespace flocklift {

struct ParameterInfo {
  std::string name;
  double value = 0;  // default; of a choice: its index
  Range range;
  std::string unit, help;
  std::vector<std::string> choices;  // the legal words; empty: it is a number
};

struct ModelInfo {
  std::string name, help, source;
  std::vector<ParameterInfo> parameters;  // in the order of the Describe
};

namespace internal {

struct CollectParameters {
  std::vector<ParameterInfo> infos;

  void operator()(std::string_view name, double value, Range range, std::string_view unit,
                  std::string_view help);
  void operator()(std::string_view name, const Choice& choice, Range range, std::string_view unit,
                  std::string_view help);
};

// Takes what the spec says; InputError, told from the spec's place in its file.
struct AssignParameters {
  const ModelSpec& spec;
  std::string kind;  // "model" or "force"

  void operator()(std::string_view name, double& value, Range range, std::string_view unit,
                  std::string_view help);
  void operator()(std::string_view name, Choice& choice, Range range, std::string_view unit,
                  std::string_view help);
};

[[noreturn]] void FailUnknownName(const std::string& kind, const ModelSpec& spec,
                                  const std::vector<ModelInfo>& known);
// Every setting of the spec must be one of the infos'.
void CheckParameterNames(const std::string& kind, const ModelSpec& spec, const ModelInfo& info);

}  // namespace internal

template <typename Parameters>
class Registry {
 public:
  struct Entry {
    std::string name, help, source;
    Parameters defaults;
  };

  // `kind` is what messages call one of them.
  Registry(std::string kind, std::vector<Entry> entries)
      : kind_(std::move(kind)), entries_(std::move(entries)) {
    for (const Entry& entry : entries_) {
      infos_.push_back({entry.name, entry.help, entry.source, Collect(entry.defaults)});
    }
  }

  const std::vector<ModelInfo>& infos() const { return infos_; }

  // Null when there is none of that name.
  const ModelInfo* Find(std::string_view name) const {
    const auto found = std::find_if(infos_.begin(), infos_.end(),
                                    [name](const ModelInfo& info) { return info.name == name; });
    return found == infos_.end() ? nullptr : &*found;
  }

  // The numbers, defaults where the spec says nothing. InputError when there is no such name or
  // parameter (the nearest is suggested) or a number is out of its range.
  Parameters Resolve(const ModelSpec& spec) const {
    const ModelInfo* const info = Find(spec.name);
    if (info == nullptr) internal::FailUnknownName(kind_, spec, infos_);
    internal::CheckParameterNames(kind_, spec, *info);
    Parameters parameters = entries_[static_cast<std::size_t>(info - infos_.data())].defaults;
    internal::AssignParameters assign{spec, kind_};
    std::visit([&assign](auto& p) { Describe(assign, p); }, parameters);
    return parameters;
  }

  // The spec with every parameter spelled out; checks as Resolve does.
  ModelSpec Complete(const ModelSpec& spec) const {
    ModelSpec complete = spec;
    for (const ParameterInfo& info : Collect(Resolve(spec))) {
      if (info.choices.empty()) {
        complete.parameters[info.name] = info.value;
      } else {
        complete.choices[info.name] = info.choices[static_cast<std::size_t>(info.value)];
      }
    }
    return complete;
  }

 private:
  static std::vector<ParameterInfo> Collect(Parameters parameters) {
    internal::CollectParameters collect;
    std::visit([&collect](auto& p) { Describe(collect, p); }, parameters);
    return std::move(collect.infos);
  }

  std::string kind_;
  std::vector<Entry> entries_;
  std::vector<ModelInfo> infos_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_FLOCK_REGISTRY_H_
