function model = @{name}()
% @{title}.
% Handles to functions of the time t, the state y, the controls u with their rates and second rates, and the parameters
% p, for one point: each takes and returns columns. The names of what they take and return are beside them.

model.state = {@{state}};
model.controls = {@{controls}};
model.parameters = {@{parameters}};
model.t0 = @{time};
model.y0 = [@{start}]';
model.values = [@{values}]';  % of the parameters; NaN where the scene gives none
@{handles}
end


@{functions}
