function worst = check_stiffness(springs, table)
% The moduli of `eigengrain stiffness --tables` computed again from its springs. Returns and prints the largest
% difference over the largest modulus. An error above 1e-8.
  moduli = read_table(table, 'moduli');
  c = elastic_tensor(springs, read_table(table, 'volume'));
  worst = max(abs(c(:) - moduli(:))) / max(abs(moduli(:)));
  fprintf('%s: %d moduli, largest difference %.1e of the largest\n', springs, numel(moduli), worst);
  if worst > 1e-8, error('the two programs disagree'); end
end
