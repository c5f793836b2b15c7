function c = elastic_tensor(springs, volume)
% Elastic tensor (Voigt's order, engineering shear) of a periodic packing from its springs, as `eigengrain stiffness
% --springs FILE` writes them: the energy of every contact in its own frame, then a pseudo-inverse of the stiffness matrix.
  p = read_springs(springs);
  n = numel(p.inverse_mass);
  solid = p.dimension == 3;
  if solid, pairs = [1 1; 2 2; 3 3; 2 3; 1 3; 1 2]; else, pairs = [1 1; 2 2; 1 2]; end
  loads = size(pairs, 1);
  k = sparse(6 * n, 6 * n);
  f = zeros(6 * n, loads);
  c = zeros(loads);
  radius = mean([p.arm_i p.arm_j]);                 % unit of rotations, so that all of K has one unit
  for s = 1:numel(p.i)
    l = p.branch(:, s);
    normal = l / norm(l);
    frame = [normal null(normal')];                 % normal and two tangents
    spring = frame * diag([p.kn(s) p.kt(s) p.kt(s)]) * frame';
    turn = [0 -normal(3) normal(2); normal(3) 0 -normal(1); -normal(2) normal(1) 0] / radius;
    at = [6 * p.i(s) + (-5:0), 6 * p.j(s) + (-5:0)];
    b = [-eye(3), p.arm_i(s) * turn, eye(3), p.arm_j(s) * turn];
    e = zeros(3, loads);
    for a = 1:loads
      strain = zeros(3);
      strain(pairs(a, 1), pairs(a, 2)) = 0.5;
      e(:, a) = (strain + strain') * l;
    end
    if p.couple(s)                                  % no strain turns grains against each other
      b = [zeros(3), -eye(3), zeros(3), eye(3)] / radius;
      e(:) = 0;
    end
    gather = sparse(1:12, at, 1, 12, 6 * n);        % adds up when i = j
    k = k + gather' * (b' * spring * b) * gather;
    f = f + gather' * (b' * spring * e);
    c = c + e' * spring * e;
  end
  if ~all(p.inverse_inertia), keep = [1 2 3]; else, keep = 1:6; end
  if ~solid, keep = intersect(keep, [1 2 6]); end
  rows = reshape(6 * (0:n - 1) + keep', [], 1);
  c = (c - f(rows, :)' * pinv(full(k(rows, rows)), 1e-11 * max(diag(k))) * f(rows, :)) / volume(1);
end
