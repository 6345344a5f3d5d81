// SPDX-License-Identifier: Apache-2.0
#include "extremes/campaign.hpp"

#include <fmt/format.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "extremes/found.hpp"

namespace kage::verif {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point from) { return std::chrono::duration<double>(Clock::now() - from).count(); }

thread_local std::array<char, 80> at_hand{};

/// Hands out starts and takes what they came to. The family that has had the least time for its weight is next.
class Campaign {
 public:
  explicit Campaign(const CampaignOptions& options) : o_(options), begin_(Clock::now()) {
    for (const Family* f : o_.families) {
      state_.families.emplace_back().family = f;
      lanes_.emplace_back();
    }
  }

  CampaignState run() {
    std::vector<std::thread> threads;
    for (int i = 0; i < o_.jobs; ++i) threads.emplace_back([this] { work(); });
    {
      std::unique_lock lock(mutex_);
      while (ended_ < o_.jobs) {
        changed_.wait_for(lock, std::chrono::milliseconds(300));
        if (o_.stop && o_.stop()) stopped_ = true;
        state_.seconds = since(begin_);
        if (o_.progress) o_.progress(done(), state_);
      }
    }
    for (std::thread& t : threads) t.join();
    if (error_) std::rethrow_exception(error_);
    state_.seconds = since(begin_);
    return std::move(state_);
  }

 private:
  struct Lane {
    std::uint64_t next = 0;  // index of its next start
    double given = 0;        // seconds, those of starts under way guessed
    bool closed = false;     // a case has failed
  };

  bool time_is_up() const { return o_.starts == 0 && since(begin_) >= o_.seconds; }

  double done() const {
    if (o_.starts == 0) return std::min(1.0, state_.seconds / o_.seconds);
    std::uint64_t starts = 0;
    for (const FamilyResult& r : state_.families) starts += r.failed_case.empty() ? r.starts : o_.starts;
    return static_cast<double>(starts) / static_cast<double>(o_.starts * lanes_.size());
  }

  // The next start; false: there is none.
  bool take(std::size_t& lane, std::uint64_t& index, double& guess) {
    const std::scoped_lock lock(mutex_);
    if (stopped_ || error_ || time_is_up()) return false;
    bool any = false;
    double least = 0;
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      const Lane& l = lanes_[i];
      if (l.closed || (o_.starts > 0 && l.next >= o_.starts)) continue;
      const double share = l.given / o_.families[i]->info().weight;
      if (any && share >= least) continue;
      any = true;
      least = share;
      lane = i;
    }
    if (!any) return false;
    index = lanes_[lane].next++;
    const FamilyResult& r = state_.families[lane];
    guess = r.starts > 0 ? r.seconds / static_cast<double>(r.starts) : 0.01;
    lanes_[lane].given += guess;
    return true;
  }

  void put(std::size_t lane, std::uint64_t index, double guess, double seconds, const Search& run) {
    const std::scoped_lock lock(mutex_);
    FamilyResult& r = state_.families[lane];
    lanes_[lane].given += seconds - guess;
    r.seconds += seconds;
    ++r.starts;
    r.cases += run.cases;
    const double before = r.sum.share();
    r.sum.add(run.sum);
    if (run.sum.share() > before) {
      r.nearest_case = case_name(*r.family, o_.seed, index);
      r.nearest = run.nearest;
    }
  }

  // A failing case is made small and kept.
  void failed(std::size_t lane, std::uint64_t index, const std::string& text, const std::string& wrong) {
    {
      const std::scoped_lock lock(mutex_);
      if (lanes_[lane].closed) return;  // another start of the same family was first
      lanes_[lane].closed = true;
    }
    const Family& family = *o_.families[lane];
    const Clock::time_point from = Clock::now();
    const std::string small =
        family.shrink(text, o_.context, [&] { return stopped_ || since(from) > o_.shrink_seconds; });
    Outcome o = family.check(small, family.info().name, o_.context);
    if (o.wrong.empty()) o.fail("it failed once, and not again: " + wrong);
    const std::string name = case_name(family, o_.seed, index);
    const auto kept = write_found(o_.found, family, small, o.wrong, name);
    const std::scoped_lock lock(mutex_);
    FamilyResult& r = state_.families[lane];
    r.failed_case = name;
    r.kept = kept;
    r.sum.wrong = o.wrong;
  }

  void work() {
    try {
      std::size_t lane = 0;
      std::uint64_t index = 0;
      double guess = 0;
      while (take(lane, index, guess)) {
        const Family& family = *o_.families[lane];
        set_case_at_hand(case_name(family, o_.seed, index));
        const Clock::time_point from = Clock::now();
        const Search run =
            family.run(o_.seed, index, o_.context, [this] { return stopped_ || (time_is_up() && o_.starts == 0); });
        put(lane, index, guess, since(from), run);
        if (run.failing) failed(lane, index, *run.failing, run.sum.wrong);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!error_) error_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    ++ended_;
    changed_.notify_all();
  }

  const CampaignOptions& o_;
  Clock::time_point begin_;
  std::mutex mutex_;
  std::condition_variable changed_;
  CampaignState state_;
  std::vector<Lane> lanes_;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr error_;
  int ended_ = 0;  // threads
};

}  // namespace

std::uint64_t CampaignState::pixels() const {
  std::uint64_t n = 0;
  for (const FamilyResult& r : families) n += r.sum.pixels;
  return n;
}

std::size_t CampaignState::failed() const {
  return static_cast<std::size_t>(
      std::count_if(families.begin(), families.end(), [](const FamilyResult& r) { return r.failed(); }));
}

std::size_t CampaignState::without_case() const {
  return static_cast<std::size_t>(
      std::count_if(families.begin(), families.end(), [](const FamilyResult& r) { return r.without_case(); }));
}

std::string case_name(const Family& family, std::uint64_t seed, std::uint64_t index) {
  return fmt::format("{}:{}:{}", family.info().name, seed, index);
}

const char* case_at_hand() { return at_hand.data(); }

void set_case_at_hand(const std::string& name) {
  const std::string held = name.substr(0, at_hand.size() - 1);
  std::copy_n(held.c_str(), held.size() + 1, at_hand.begin());
}

CampaignState run_campaign(const CampaignOptions& options) { return Campaign(options).run(); }

}  // namespace kage::verif
