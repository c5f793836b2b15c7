function [f, rotation] = bloch_frequencies(cell, k)
% Frequencies [Hz], ascending, of the waves exp(1i*k'*x) of a periodic packing, and the share of rotation in each one's
% kinetic energy. cell: see read_springs; k: column of three [rad/m].
%
% Every contact has three springs in its own frame (n, s, t): elongation and two slips (a couple: rotations), as rows of a compatibility matrix
% B (springs by motions). Then B' * stiffness * B * u = omega^2 * mass * u.
  grains = numel(cell.inverse_mass);
  springs = numel(cell.i);
  B = zeros(3 * springs, 6 * grains);
  stiffness = zeros(3 * springs, 1);
  for c = 1:springs
    frame = contact_frame(cell.branch(:, c));
    phase = exp(1i * (k' * cell.branch(:, c)));
    rows = 3 * c - 2:3 * c;
    from = 6 * cell.i(c) - 5:6 * cell.i(c);
    to = 6 * cell.j(c) - 5:6 * cell.j(c);
    of_i = material_point(cell.arm_i(c) * frame(:, 1));
    of_j = material_point(-cell.arm_j(c) * frame(:, 1));
    if cell.couple(c), of_i = [zeros(3), eye(3)]; of_j = of_i; end
    B(rows, from) = B(rows, from) - frame' * of_i;
    B(rows, to) = B(rows, to) + phase * frame' * of_j;
    stiffness(rows) = [cell.kn(c); cell.kt(c); cell.kt(c)];
  end
  inverse = [repmat(cell.inverse_mass, 3, 1); repmat(cell.inverse_inertia, 3, 1)];
  inverse = inverse(:);
  is_rotation = repmat([false; false; false; true; true; true], grains, 1);
  keep = inverse > 0;
  if cell.dimension == 2
    keep = keep & repmat([true; true; false; false; false; true], grains, 1);
  end
  scaled = bsxfun(@times, sqrt(stiffness), bsxfun(@times, B(:, keep), sqrt(inverse(keep))'));
  matrix = scaled' * scaled;
  [modes, squares] = eig((matrix + matrix') / 2);
  [squares, order] = sort(real(diag(squares)));
  f = sqrt(max(squares, 0)) / (2 * pi);
  rotation = sum(abs(modes(is_rotation(keep), order)).^2, 1)';
end

function A = material_point(arm)
% Velocity of a point of a grain at `arm` from its centre: v + w x arm = A * [v; w].
  A = [eye(3), -[0, -arm(3), arm(2); arm(3), 0, -arm(1); -arm(2), arm(1), 0]];
end

function frame = contact_frame(branch)
% Columns: unit normal along the branch and two tangents.
  n = branch / norm(branch);
  [~, smallest] = min(abs(n));
  e = zeros(3, 1);
  e(smallest) = 1;
  s = cross(n, e);
  s = s / norm(s);
  frame = [n, s, cross(n, s)];
end
