function cell = read_springs(file)
% Masses and springs of a unit cell, as `eigengrain waves dispersion --springs FILE` writes them (see README.md).
  id = fopen(file);
  if id < 0, error('%s: cannot be read', file); end
  numbers = fscanf(id, '%f');
  fclose(id);
  cell.dimension = numbers(1);
  grains = numbers(2);
  springs = numbers(3);
  masses = reshape(numbers(4:3 + 2 * grains), 2, grains);
  rest = reshape(numbers(4 + 2 * grains:end), 10, springs);
  cell.inverse_mass = masses(1, :);
  cell.inverse_inertia = masses(2, :);
  cell.i = rest(1, :);
  cell.j = rest(2, :);
  cell.branch = rest(3:5, :);
  cell.kn = rest(6, :);
  cell.kt = rest(7, :);
  cell.arm_i = rest(8, :);
  cell.arm_j = rest(9, :);
  cell.couple = rest(10, :) > 0;
end
