#include "eigen/arpack_general.hpp"

#include <arpack/arpack.h>

#include <algorithm>

#include "eigen/vectors.hpp"

namespace eg {

std::vector<std::complex<double>> arpack_general(
    std::size_t rows, const std::function<void(std::span<const double>, std::span<double>)>& apply, SpectrumEnd end,
    const GeneralArpackOptions& options) {
  const char* which = end == SpectrumEnd::largest_magnitude   ? "LM"
                      : end == SpectrumEnd::largest_imaginary ? "LI"
                                                              : "SR";
  const auto n = static_cast<a_int>(rows);
  const a_int ncv = std::min<a_int>(options.basis, n), nev = std::min<a_int>(options.wanted, ncv - 2);
  const a_int lworkl = 3 * ncv * (ncv + 2);
  const auto size = [](a_int a, a_int b = 1) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); };
  std::vector<double> resid = random_unit_vector(rows, options.seed), v(size(n, ncv)), workd(size(n, 3)),
                      workl(size(lworkl)), workev(size(3, ncv)), re(size(nev + 1)), im(size(nev + 1));
  a_int iparam[11] = {1, 0, options.max_restarts, 1, 0, 0, 1, 0, 0, 0, 0}, ipntr[14] = {};
  a_int ido = 0, info = 1;  // the start vector is given
  while (true) {
    dnaupd_c(&ido, "I", n, which, nev, options.tolerance, resid.data(), ncv, v.data(), n, iparam, ipntr, workd.data(),
             workl.data(), lworkl, &info);
    if (ido != 1 && ido != -1) break;
    const std::span all(workd);
    apply(all.subspan(size(ipntr[0] - 1), rows), all.subspan(size(ipntr[1] - 1), rows));
  }
  std::vector<std::complex<double>> values;
  if (info < 0 || iparam[4] == 0) return values;  // info > 0: not all that were wanted
  std::vector<a_int> select(size(ncv));
  dneupd_c(0, "A", select.data(), re.data(), im.data(), v.data(), n, 0, 0, workev.data(), "I", n, which, nev,
           options.tolerance, resid.data(), ncv, v.data(), n, iparam, ipntr, workd.data(), workl.data(), lworkl, &info);
  if (info != 0) return values;
  for (a_int k = 0; k < std::min(iparam[4], nev + 1); ++k) values.emplace_back(re[size(k)], im[size(k)]);
  return values;
}

}  // namespace eg
