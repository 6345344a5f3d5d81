// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_store.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "cosim/model/sha256.hpp"
#include "file/one_line.hpp"
#include "kage/error.hpp"

namespace kage::explore {
namespace {

// "KAGE": what SQLite's header keeps of a store and of no other file.
constexpr int kApplication = 0x4B414745;

// Another program's transaction is waited for so long.
constexpr int kBusyMilliseconds = 60000;

// `sum`: sum_of() of the columns before it, so that a row whose bytes have changed is told from one that was kept.
constexpr const char* kRunTable =
    "CREATE TABLE run (key TEXT PRIMARY KEY, scene TEXT NOT NULL, point TEXT NOT NULL, row TEXT NOT NULL, "
    "build TEXT NOT NULL, faces TEXT NOT NULL, tools TEXT NOT NULL, sum TEXT NOT NULL, "
    "made TEXT NOT NULL DEFAULT CURRENT_TIMESTAMP) WITHOUT ROWID";
constexpr const char* kClocksTable =
    "CREATE TABLE clocks (key TEXT PRIMARY KEY, cycles INTEGER NOT NULL, foretold INTEGER NOT NULL, "
    "seconds REAL NOT NULL, sum TEXT NOT NULL) WITHOUT ROWID";

/// Checksum of a row's columns.
std::string sum_of(const std::vector<std::string>& columns) {
  cosim::Sha256 hash;
  for (const std::string& text : columns) hash.add(text);
  return hash.take();
}

std::string sum_of(const std::string& key, const ClockSample& sample) {
  return sum_of(
      {key, std::to_string(sample.cycles), std::to_string(sample.foretold), fmt::format("{}", sample.seconds)});
}

/// A file's name as SQLite takes it for one: ":memory:" would be none.
std::string sqlite_name(const std::filesystem::path& file) { return std::filesystem::absolute(file).string(); }

[[noreturn]] void damaged(const std::string& file, const std::string& how) {
  throw Error(fmt::format("{}: the store is damaged, so begin another: {}", file, how));
}

/// A damaged store's name of something, on one line: it may be of any bytes, and as long as it likes.
std::string plain_text(std::string name) {
  constexpr std::size_t kShown = 64;
  name.resize(std::min(name.size(), kShown));
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name;
}

[[noreturn]] void damaged_row(const std::string& file, const char* table, const std::string& key) {
  damaged(file, fmt::format("table {}, row {}: its checksum differs", table, plain_text(key)));
}

/// The failure that has just happened, in words for a person who runs a sweep.
std::string cause_of_failure(sqlite3* db) {
  const int error = sqlite3_system_errno(db);
  const std::string of_system = error == 0 ? "" : fmt::format(": {}", std::strerror(error));
  switch (sqlite3_errcode(db)) {
    case SQLITE_READONLY:
      return "the store cannot be written: it may only be read, or is gone";
    case SQLITE_FULL:
      return "the store cannot be written: its disk is full";
    case SQLITE_IOERR:
      return "the store cannot be read or written" + of_system;
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "the store cannot be opened" + of_system;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program keeps the store locked";
    case SQLITE_NOMEM:
      return "out of memory";
    default:
      return "the store cannot be used";
  }
}

/// Throws what has just gone wrong.
[[noreturn]] void fail(const std::string& file, sqlite3* db) {
  switch (sqlite3_errcode(db)) {
    case SQLITE_NOTADB:
      throw Error(fmt::format("{}: no store of kage sweep: it is no SQLite file", file));
    case SQLITE_CORRUPT:
      damaged(file, one_line(sqlite3_errmsg(db)));
    default:
      throw Error(fmt::format("{}: {} (SQLite: {})", file, cause_of_failure(db), one_line(sqlite3_errmsg(db))));
  }
}

/// A statement that is stepped, and let go.
class Statement {
 public:
  Statement(sqlite3* db, const std::string& file, std::string_view sql) : db_(db), file_(file) {
    check(sqlite3_prepare_v2(db, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& bind(const std::string& text) {
    check(sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
    return *this;
  }
  Statement& bind(std::uint64_t number) {
    check(sqlite3_bind_int64(statement_, ++bound_, static_cast<sqlite3_int64>(number)));
    return *this;
  }
  Statement& bind(double number) {
    check(sqlite3_bind_double(statement_, ++bound_, number));
    return *this;
  }

  /// Whether there is a row.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) check(code);
    return code == SQLITE_ROW;
  }
  [[nodiscard]] std::string text(int column) const {
    const unsigned char* const text = sqlite3_column_text(statement_, column);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_, column));
    return text == nullptr ? "" : std::string(reinterpret_cast<const char*>(text), size);
  }
  [[nodiscard]] std::int64_t number(int column) const { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] double real(int column) const { return sqlite3_column_double(statement_, column); }

 private:
  void check(int code) const {
    if (code != SQLITE_OK) fail(file_, db_);
  }

  sqlite3* db_;
  const std::string& file_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
};

}  // namespace

struct SweepStore::Data {
  std::string file;
  sqlite3* db = nullptr;
  std::mutex mutex;

  ~Data() { sqlite3_close(db); }

  explicit Data(const std::filesystem::path& path) : file(path.string()) {}
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  /// `create`: SQLITE_OPEN_CREATE, or 0 for a file that must be there.
  void open(int create) {
    std::error_code ec;
    if (std::filesystem::is_directory(file, ec)) throw Error(fmt::format("{}: a folder, and no store", file));
    const std::string name = sqlite_name(file);
    if (!std::filesystem::is_directory(std::filesystem::path(name).parent_path(), ec))
      throw Error(fmt::format("{}: no such folder", file));
    if (sqlite3_open_v2(name.c_str(), &db, SQLITE_OPEN_READWRITE | create | SQLITE_OPEN_FULLMUTEX, nullptr) !=
        SQLITE_OK)
      fail(file, db);
    sqlite3_busy_timeout(db, kBusyMilliseconds);
  }
  [[nodiscard]] std::int64_t number(std::string_view sql) const {
    Statement s(db, file, sql);
    return s.step() ? s.number(0) : 0;
  }
  void execute(const char* sql) const {
    if (sqlite3_exec(db, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(file, db);
  }
  /// All in one transaction.
  template <class Work>
  void at_once(Work work) {
    execute("BEGIN IMMEDIATE");
    try {
      work();
      execute("COMMIT");
    } catch (...) {
      sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
      throw;
    }
  }

  /// A view or a trigger in place of a table might never end, or write.
  void check_schema() const {
    // SQLite's own tables, as of ANALYZE, have names that no other table may have.
    Statement s(db, file,
                "SELECT name, sql FROM sqlite_master WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY name");
    for (const auto& [name, sql] : {std::pair{"clocks", kClocksTable}, {"run", kRunTable}})
      if (!s.step() || s.text(0) != name || s.text(1) != sql)
        damaged(file, fmt::format("{} is not the table that kage makes", name));
    if (s.step()) damaged(file, fmt::format("it has {}, which kage does not make", plain_text(s.text(0))));
  }
  /// A row of `run`, taken out of the statement's columns 0 to 7.
  void check_run(const Statement& s) const {
    std::vector<std::string> columns;
    for (int i = 0; i < 7; ++i) columns.push_back(s.text(i));
    if (sum_of(columns) != s.text(7)) damaged_row(file, "run", columns.front());
  }
  /// A row of `clocks`, of the statement's columns 0 to 4.
  [[nodiscard]] ClockSample checked_clocks(const Statement& s) const {
    const ClockSample sample{static_cast<std::uint64_t>(s.number(1)), static_cast<std::uint64_t>(s.number(2)),
                             s.real(3)};
    if (sum_of(s.text(0), sample) != s.text(4)) damaged_row(file, "clocks", s.text(0));
    return sample;
  }
  void check_rows() const {
    for (Statement s(db, file, "SELECT key, scene, point, row, build, faces, tools, sum FROM run"); s.step();)
      check_run(s);
    for (Statement s(db, file, "SELECT key, cycles, foretold, seconds, sum FROM clocks"); s.step();)
      (void)checked_clocks(s);
  }

  void check_version() {
    if (number("PRAGMA application_id") != kApplication)
      throw Error(fmt::format("{}: no store of kage sweep, though an SQLite file", file));
    const std::int64_t version = number("PRAGMA user_version");
    if (version != kVersion)
      throw Error(fmt::format("{}: a store of version {}, and this kage has {}", file, version, kVersion));
    check_schema();
    Statement s(db, file, "PRAGMA quick_check(1)");
    const std::string found = s.step() ? s.text(0) : "nothing";
    if (found != "ok") damaged(file, one_line(found.starts_with("***") ? found.substr(found.find('\n') + 1) : found));
  }
};

SweepStore::SweepStore(const std::filesystem::path& file) : data_(std::make_unique<Data>(file)) {
  Data& d = *data_;
  d.open(SQLITE_OPEN_CREATE);
  if (d.number("SELECT count(*) FROM sqlite_master") > 0 || d.number("PRAGMA application_id") != 0) {
    d.check_version();
  } else {
    d.at_once([&] {
      if (d.number("SELECT count(*) FROM sqlite_master") > 0) return;  // another program was first
      d.execute(kRunTable);
      d.execute(kClocksTable);
      d.execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplication, kVersion).c_str());
    });
    d.check_version();
  }
  // A row that is told to be kept is on the disk.
  d.execute("PRAGMA synchronous = FULL");
}

SweepStore::~SweepStore() = default;

std::optional<std::string> SweepStore::run(const std::string& key) {
  const std::lock_guard lock(data_->mutex);
  Statement s(data_->db, data_->file, "SELECT key, scene, point, row, build, faces, tools, sum FROM run WHERE key = ?");
  if (!s.bind(key).step()) return std::nullopt;
  data_->check_run(s);
  return s.text(3);
}

void SweepStore::keep_run(const std::string& key, const std::string& scene, const std::string& point, const MadeOf& of,
                          const std::string& row) {
  const std::lock_guard lock(data_->mutex);
  data_->at_once([&] {
    Statement s(data_->db, data_->file,
                "INSERT OR REPLACE INTO run (key, scene, point, row, build, faces, tools, sum) VALUES (?, ?, ?, ?, ?, "
                "?, ?, ?)");
    const std::vector<std::string> columns{key, scene, point, row, of.build, of.scene, of.tools};
    for (const std::string& text : columns) s.bind(text);
    s.bind(sum_of(columns)).step();
  });
}

std::string SweepStore::old(const std::string& scene, const std::string& point, const MadeOf& of) {
  const std::lock_guard lock(data_->mutex);
  // A row counts for as far as it is the same: build, then scene, then tools.
  Statement s(data_->db, data_->file,
              "SELECT count(*), max((build = ?) * (1 + (faces = ?) * (1 + (tools = ?)))) FROM run "
              "WHERE scene = ? AND point = ?");
  s.bind(of.build).bind(of.scene).bind(of.tools).bind(scene).bind(point).step();
  if (s.number(0) == 0) return "";
  switch (s.number(1)) {
    case 0:
      return "another build of kage";
    case 1:
      return "another scene of this name";
    case 2:
      return "other tools, or of more or fewer of them";
    default:
      return "";
  }
}

std::optional<ClockSample> SweepStore::clocks(const std::string& key) {
  const std::lock_guard lock(data_->mutex);
  Statement s(data_->db, data_->file, "SELECT key, cycles, foretold, seconds, sum FROM clocks WHERE key = ?");
  if (!s.bind(key).step()) return std::nullopt;
  return data_->checked_clocks(s);
}

void SweepStore::keep_clocks(const std::string& key, const ClockSample& sample) {
  const std::lock_guard lock(data_->mutex);
  data_->at_once([&] {
    Statement s(data_->db, data_->file,
                "INSERT OR REPLACE INTO clocks (key, cycles, foretold, seconds, sum) VALUES (?, ?, ?, ?, ?)");
    s.bind(key).bind(sample.cycles).bind(sample.foretold).bind(sample.seconds).bind(sum_of(key, sample)).step();
  });
}

bool SweepStore::is_empty(const std::filesystem::path& file) {
  std::error_code ec;
  return std::filesystem::is_regular_file(file, ec) && std::filesystem::file_size(file, ec) == 0;
}

void SweepStore::check(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) throw Error(fmt::format("{}: no such file", file.string()));
  if (is_empty(file)) throw Error(fmt::format("{}: no store of kage sweep: it is empty", file.string()));
  Data d(file);
  d.open(0);
  d.check_version();
  d.check_rows();
}

int SweepStore::absorb(const std::filesystem::path& other) {
  check(other);
  const int before = runs();
  const std::lock_guard lock(data_->mutex);
  Data& d = *data_;
  Statement(d.db, d.file, "ATTACH ? AS other").bind(sqlite_name(other)).step();
  d.at_once([&] {
    d.execute(
        "INSERT OR IGNORE INTO run SELECT * FROM other.run;"
        "INSERT OR IGNORE INTO clocks SELECT * FROM other.clocks;");
  });
  d.execute("DETACH other");
  return static_cast<int>(d.number("SELECT count(*) FROM run")) - before;
}

int SweepStore::runs() {
  const std::lock_guard lock(data_->mutex);
  return static_cast<int>(data_->number("SELECT count(*) FROM run"));
}

}  // namespace kage::explore
