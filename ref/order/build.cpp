// SPDX-License-Identifier: Apache-2.0
//
// Sets of fragments are cut, one after the other, by a plane of one of their faces. Each set has its own chance, drawn
// from its parent's, and nothing else passes between sets: so the tree is the same whichever thread takes which.
#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>

#include "arena/arena.hpp"
#include "kage/error.hpp"
#include "order/build_node.hpp"
#include "order/splitter.hpp"

namespace kage::order {
namespace {

/// Sets at least this large may go to another thread.
constexpr std::size_t kTask = 1024;

/// Fragments that are put on a side between two calls of OrderBuildOptions::progress: some milliseconds.
constexpr std::uint64_t kReport = 4096;

/// Estimated work for a set, for the progress: n faces that all cut one another come to n^3 / 7 fragments. Faces of
/// real meshes hardly cut one another, and then it matters little, because sets are cut in halves.
double work_of(const std::vector<BuildFragment>& set) {
  const auto n = static_cast<double>(set.size());
  return n * n * n;
}

struct Set {
  std::vector<BuildFragment> fragments;
  BuildNode** link;
  std::uint64_t random;
  double share;  ///< of the whole build, as estimated, that its nodes will take
};

class Builder {
 public:
  Builder(const Faces& faces, const OrderBuildOptions& options, OrderBuildStats& stats)
      : faces_(faces),
        options_(options),
        stats_(stats),
        total_(faces.faces.size()),
        limit_(options.max_fragments.value_or(std::max<std::uint64_t>(OrderBuildOptions::kFragments, 4 * total_))) {}

  BuildTree run() {
    check_limit(total_);
    Set all{{}, &tree_.root, options_.seed, 1};
    all.fragments.resize(faces_.faces.size());
    for (std::size_t f = 0; f < all.fragments.size(); ++f) all.fragments[f].face = static_cast<std::uint32_t>(f);
    if (all.fragments.empty()) return std::move(tree_);
    Arena arena(options_.threads);
    // A tbb::task_group that finds no memory for a task waits for that task for ever, in its destructor.
    const SharedSet first = std::make_shared<Set>(std::move(all));
    hand_on(first.get());
    arena.execute([&] {
      tbb::parallel_for_each(&first, &first + 1, [this](const SharedSet& set, Feeder& feeder) {
        take_over(set.get());
        work(std::move(*set), feeder);
        hand_on(this);
      });
    });
    take_over(this);
    if (options_.progress) options_.progress(1);
    stats_.splits = total_ - faces_.faces.size();
    return std::move(tree_);
  }

 private:
  using SharedSet = std::shared_ptr<Set>;  // TBB copies what it hands on
  using Feeder = tbb::feeder<SharedSet>;

  /// Takes a set and all that comes of it, but for what it gives to other threads by way of `feeder`.
  void work(Set first, Feeder& feeder) {
    std::deque<BuildNode> nodes;
    Classifier classifier(faces_);
    SplitterChoice choice(faces_);
    std::vector<Set> stack;
    stack.push_back(std::move(first));
    Done done;
    while (!stack.empty()) {
      Set set = std::move(stack.back());
      stack.pop_back();
      BuildNode& node = nodes.emplace_back();
      *set.link = &node;
      node.face = choice.choose(set.fragments, set.random);
      std::array<Set, 2> side{Set{{}, &node.child[0], next_random(set.random), 0},
                              Set{{}, &node.child[1], next_random(set.random), 0}};
      divide(set.fragments, node, classifier, side[0].fragments, side[1].fragments, done);
      const double each =
          set.share / (work_of(node.fragments) + work_of(side[0].fragments) + work_of(side[1].fragments));
      done.share += each * work_of(node.fragments);
      for (Set& s : side) {
        if (s.fragments.empty()) continue;
        s.share = each * work_of(s.fragments);
        if (s.fragments.size() >= kTask && !stack.empty())
          give(std::move(s), feeder);
        else
          stack.push_back(std::move(s));
      }
    }
    report(done);
    const std::scoped_lock lock(mutex_);
    stats_.side_tests += classifier.tests();
    stats_.exact_tests += classifier.exact();
    tree_.nodes.push_back(std::move(nodes));
  }

  /// To whichever thread is free.
  static void give(Set set, Feeder& feeder) {
    const SharedSet shared = std::make_shared<Set>(std::move(set));
    hand_on(shared.get());
    feeder.add(shared);
  }

  /// Work that a thread has done and not reported yet.
  struct Done {
    double share = 0;
    std::uint64_t fragments = 0;  ///< put on a side, be it for good or not
  };

  void divide(std::vector<BuildFragment>& set, BuildNode& node, Classifier& classifier,
              std::vector<BuildFragment>& front, std::vector<BuildFragment>& back, Done& done) {
    const Splitter plane(faces_, node.face);
    for (BuildFragment& f : set) {
      if (++done.fragments >= kReport) report(done);
      switch (classifier.classify(f, plane)) {
        case Side::kFront:
          front.push_back(std::move(f));
          break;
        case Side::kBack:
          back.push_back(std::move(f));
          break;
        case Side::kOn:
          node.fragments.push_back(std::move(f));
          break;
        case Side::kBoth: {
          check_limit(total_.fetch_add(1) + 1);
          auto [before, behind] = classifier.split(f, plane, &node);
          front.push_back(std::move(before));
          back.push_back(std::move(behind));
          break;
        }
      }
    }
    std::vector<BuildFragment>().swap(set);
  }

  void check_limit(std::uint64_t fragments) const {
    if (fragments > limit_) throw TooManyFragments(limit_);
  }

  void report(Done& done) {
    const std::scoped_lock lock(mutex_);
    share_ += done.share;
    done = {};
    if (options_.progress) options_.progress(std::min(share_, 1.0));  // rounding may have gone past 1
  }

  const Faces& faces_;
  const OrderBuildOptions& options_;
  OrderBuildStats& stats_;
  std::atomic<std::uint64_t> total_;
  std::uint64_t limit_;
  std::mutex mutex_;
  BuildTree tree_;
  double share_ = 0;
};

}  // namespace

BuildTree build_tree(const Faces& faces, const OrderBuildOptions& options, OrderBuildStats& stats) {
  return Builder(faces, options, stats).run();
}

}  // namespace kage::order

namespace kage {

TooManyFragments::TooManyFragments(std::uint64_t limit, const std::string& where)
    : Error(fmt::format("{}{}to be put in order, polygons would be cut into more than {} fragments", where,
                        where.empty() ? "" : ": ", limit)),
      limit_(limit) {}

}  // namespace kage
