function worst = check_dispersion(springs, table)
% Every frequency of a table of `eigengrain waves dispersion` computed again from the springs of the unit cell. Returns
% and prints the largest difference |f^2 - g^2| / (2 F max(f, F/1000)), F the highest frequency: the difference of the
% frequencies over the highest one, blunt only where f is all but zero and known to half the digits. An error above 1e-8.
  cell = read_springs(springs);
  k = read_table(table, 'k');
  frequency = read_table(table, 'frequency');
  highest = max(frequency(:));
  worst = 0;
  for p = 1:size(k, 2)
    f = frequency(:, p);
    g = bloch_frequencies(cell, k(:, p));
    worst = max(worst, max(abs(f.^2 - g.^2) ./ (2 * highest * max(f, 1e-3 * highest))));
  end
  fprintf('%s: %d wave vectors, %d branches, largest difference %.1e of the highest frequency\n', springs, ...
          size(k, 2), size(frequency, 1), worst);
  if worst > 1e-8, error('the two programs disagree'); end
end
