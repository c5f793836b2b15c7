function data = read_table(file, name)
% A dataset of an HDF5 file, columns first as both programs store it: h5read in MATLAB, load in Octave.
  if exist('h5read', 'file')
    data = h5read(file, ['/' name]);
  else
    content = load('-hdf5', file);
    data = content.(name);
  end
end
