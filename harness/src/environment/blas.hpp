// Which BLAS and LAPACK the process runs on: pairs of Debian's packages, chosen at start.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mbs {

/// A BLAS and a LAPACK that can be selected together, `mbs ... --blas NAME`.
struct BlasPair {
  std::string name;     ///< "openblas", "openblas-reference", ...
  std::string blas;     ///< what the BLAS is, for tables: "OpenBLAS (successor of GotoBLAS)"
  std::string lapack;   ///< what the LAPACK is
  std::string package;  ///< Debian packages that provide the files
  /// libblas.so.3 and liblapack.so.3 of the pair, and a library that is loaded before them.
  std::filesystem::path blas_file, lapack_file, preload;
};

/// All pairs that the study knows, whether installed or not; files below `root`
/// ("/usr/lib/<arch>").
std::vector<BlasPair> blas_pairs(const std::filesystem::path& root);
/// The same on this system.
const std::vector<BlasPair>& blas_pairs();

/// Why `pair` cannot be selected: the files that are missing and the packages that have them;
/// empty if it can.
std::string why_unavailable(const BlasPair& pair);

/// The value of --blas in a command line, if there is one; the last one counts.
std::optional<std::string> asked_blas(int argc, const char* const* argv);

/// The pair called `name`. Throws UsageError that lists the pairs if there is none, or with the
/// packages to install if its files are missing.
const BlasPair& available_pair(const std::string& name);

/// Names and values of the environment with which the loader takes this pair, given the present
/// LD_LIBRARY_PATH and LD_PRELOAD ("" if unset); only those that must change.
std::vector<std::pair<std::string, std::string>> loader_environment(const BlasPair& pair,
                                                                    const std::string& library_path,
                                                                    const std::string& preload);

/// What is wrong if a process with these files mapped is to run on `pair` and on no other of `all`;
/// empty if nothing.
std::string why_not_in_effect(const BlasPair& pair, const std::vector<BlasPair>& all,
                              const std::vector<std::string>& mapped);

/// The files behind the generic names libblas.so.3 and liblapack.so.3 in this process.
std::vector<std::string> generic_blas_files();

/// What is wrong if `own` files are to be the only BLAS and LAPACK of a process with these files
/// mapped; empty if nothing. A file with a maker's name has to be of the same maker and in the
/// folder of one of `own` or the folder above, where Debian has libatlas.
std::string why_foreign(const std::vector<std::string>& own,
                        const std::vector<std::string>& mapped);

}  // namespace mbs
